// SPDX-License-Identifier: Apache-2.0
// From a page's message to the line for the launcher, and the report to the pages.
#include "host/server/scene_picker.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "tests/support/viewer_fixture.h"

namespace tact::test::scene_picker_test {

using host::server::Link;
using nlohmann::json;

constexpr const char* kHeart = R"({"format":"tactd-parameters","version":1,"scene":"heart",
  "law":"disc_stack","simulated":true,"parameters":[
  {"key":"disc_stack.layers","unit":"","value":20,"low":1,"high":31,"whole":true,"meaning":"n"},
  {"key":"disc_stack.poisson_ratio","unit":"","value":0.3,"low":0,"high":0.495,"whole":false,
   "meaning":"mu"}]})";
constexpr const char* kLiver =
    R"({"format":"tactd-parameters","scene":"liver","simulated":true,"parameters":[
  {"key":"rhombus.growth","value":6.5,"live":true},{"key":"rhombus.units","value":10,"live":false},
  {"key":"elastic.youngs_modulus_Pa","value":5000,"live":true}]})";

class Picker : public ::testing::Test {
 protected:
  Picker() : folder_(testing::TempDir() + "tact-picker-" + std::to_string(getpid())) {
    fs::create_directories(folder_);
    std::ofstream(folder_ + "/liver.json") << kLiver;
    EXPECT_EQ(load(kHeart), "");
  }
  ~Picker() override { fs::remove_all(folder_); }

  std::string load(const std::string& heart) {
    std::ofstream(folder_ + "/heart.json") << heart;
    return tests::message_of(picker_.load(folder_));
  }
  void show(const char* scene, bool is_simulated, Link link = Link::kLive) {
    RunHeader header = make_header(3, 1, 3, 1);
    header.scene_name = scene;
    header.simulated = is_simulated;
    view_.begin(header, TinyMeshes{}.bytes(), link);
    picker_.begin();
  }
  void ask(const char* request) { picker_.ask(json::parse(request)); }
  json reported() const { return json::parse(*view_.status()).value("picker", json()); }
  std::string answer() const { return reported().value("answer", "nothing is offered"); }

  const std::string folder_;
  host::server::LiveView view_;
  std::vector<std::string> lines_;
  host::server::ScenePicker picker_{view_,
                                    [this](const std::string& line) { lines_.push_back(line); }};
};

TEST_F(Picker, SendsAGoodRequestAndReportsWhenItRuns) {
  show("liver", true);
  EXPECT_EQ(reported()["scene"], "liver");
  ask(R"({"scene":"heart","set":{"disc_stack.layers":12,"disc_stack.poisson_ratio":1e-5}})");
  EXPECT_EQ(lines_, std::vector<std::string>{
                        "request heart disc_stack.layers=12 disc_stack.poisson_ratio=1e-05"});
  EXPECT_EQ(reported()["asked"], "heart");
  EXPECT_EQ(reported()["scene"], "liver") << "it has not come yet";
  show("heart", true);
  EXPECT_EQ(reported()["asked"], "");
  EXPECT_EQ(reported()["scene"], "heart");
  EXPECT_EQ(reported()["set"]["disc_stack.layers"], 12);
}

TEST_F(Picker, SetsNumbersOfTheSceneThatRunsWithoutAnotherStart) {
  show("liver", true);
  ask(R"({"scene":"liver","set":{"elastic.youngs_modulus_Pa":4000}})");
  EXPECT_EQ(lines_.back(), "set liver elastic.youngs_modulus_Pa=4000");
  EXPECT_EQ(reported()["asked"], "liver");
  picker_.answer("done elastic.youngs_modulus_Pa=4000: set");
  EXPECT_EQ(reported()["asked"], "");
  EXPECT_EQ(reported()["note"], "elastic.youngs_modulus_Pa=4000: set");
  EXPECT_EQ(reported()["set"]["elastic.youngs_modulus_Pa"], 4000);
  ask(R"({"scene":"liver","set":{}})");
  EXPECT_EQ(lines_.back(), "set liver elastic.youngs_modulus_Pa=5000") << "as shipped again";
  picker_.answer("not set: too stiff");
  EXPECT_EQ(answer(), "not set: too stiff");
  EXPECT_EQ(reported()["set"]["elastic.youngs_modulus_Pa"], 4000) << "what runs";
  ask(R"({"scene":"liver","set":{"elastic.youngs_modulus_Pa":4000,"rhombus.units":9}})");
  EXPECT_EQ(lines_.back(), "request liver elastic.youngs_modulus_Pa=4000 rhombus.units=9");
}

TEST_F(Picker, RefusesWhatIsNotOfferedByName) {
  show("liver", true);
  for (const auto& [request, reason] :
       {std::pair{R"({"scene":"skin"})", "there is no scene \"skin\" here"},
        {R"({"scene":"../heart"})", "there is no scene \"../heart\" here"},
        {R"({"scene":7})", "there is no scene \"\" here"},
        {R"({})", "there is no scene \"\" here"},
        {R"({"scene":"heart","set":{"limits.force_N":8}})",
         "heart has no parameter \"limits.force_N\""},
        {R"({"scene":"heart","set":[8]})", "\"set\" has no numbers by key"},
        {R"({"scene":"heart","set":{"disc_stack.layers":"12 --arm"}})",
         "disc_stack.layers = \"12 --arm\" is no number"}}) {
    ask(request);
    EXPECT_EQ(answer(), reason);
  }
  EXPECT_TRUE(lines_.empty());
}

TEST_F(Picker, OffersAndSendsNothingWhereTheDeviceIsNotSimulated) {
  show("liver", false);
  EXPECT_TRUE(reported().is_null());
  ask(R"({"scene":"heart"})");
  EXPECT_TRUE(lines_.empty());
}

TEST_F(Picker, SendsNothingBeforeATactdIsThere) {
  ask(R"({"scene":"heart"})");
  EXPECT_TRUE(lines_.empty());
}

TEST_F(Picker, SendsOneRequestAtATime) {
  show("liver", true);
  ask(R"({"scene":"heart"})");
  ask(R"({"scene":"liver"})");
  EXPECT_EQ(lines_.size(), 1u);
  EXPECT_NE(answer().find("is being started"), std::string::npos);
}

TEST_F(Picker, ReportsWhyARequestWasRefusedAndTakesTheNext) {
  show("liver", true);
  ask(R"({"scene":"heart"})");
  picker_.answer("tactd: too stiff \xff");
  EXPECT_EQ(answer(), "tactd: too stiff \xef\xbf\xbd") << "what is no UTF-8 is replaced";
  EXPECT_EQ(reported()["scene"], "liver");
  EXPECT_EQ(reported()["asked"], "");
  ask(R"({"scene":"heart"})");
  EXPECT_EQ(lines_.size(), 2u);
  EXPECT_EQ(answer(), "");
}

TEST_F(Picker, LoadsOnlyParametersOfSimulatedScenes) {
  const std::string good = kHeart;
  for (const auto& [what, instead] : {std::pair{"\"heart\"", "7"},
                                      {"tactd-parameters", "tactd-faults"},
                                      {"true,\"parameters", "false,\"parameters"},
                                      {"\"simulated\":true,", ""},
                                      {"\"key\"", "\"name\""},
                                      {"}]}", ""}}) {
    std::string bad = good;
    bad.replace(bad.find(what), std::string_view(what).size(), instead);
    EXPECT_NE(load(bad).find("--parameters --json"), std::string::npos) << what << " " << instead;
  }
  host::server::ScenePicker none(view_, nullptr);
  EXPECT_NE(tests::message_of(none.load("/nowhere")).find("--parameters --json"),
            std::string::npos);
}

/// What a page asks over its WebSocket.
class Chooser : public Viewer {
 protected:
  /// Of a server that gives its pages this right over the hand: is a request heard?
  bool is_heard(const host::server::MoveHand& move_hand) {
    host::server::ViewerServer server(io_, view_, move_hand);
    server.let_choose([this](const json&) { ++requests_; }, "[]");
    start();  // the thread, and a server beside
    EXPECT_FALSE(server.open({.port = 0, .page_folder = folder_}));
    server.start();
    Socket socket(client_io_);
    socket.next_layer().connect({boost::asio::ip::make_address("127.0.0.1"), server.port()});
    socket.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
      request.set(http::field::origin, "http://localhost:1");
      request.set(http::field::authorization, "Bearer " + server.token());
    }));
    error_code wrong;
    socket.handshake("localhost:1", "/live", wrong);
    EXPECT_FALSE(wrong);
    socket.text(true);
    socket.write(boost::asio::buffer(std::string_view(R"({"request":{"scene":"heart"}})")));
    socket.close(websocket::close_code::normal, wrong);  // answered after all before it was taken
    boost::asio::post(io_, [this] { io_.stop(); });      // before its server goes
    thread_.join();
    return requests_ > 0;
  }
  int requests_ = 0;
};

TEST_F(Chooser, IsHeardWhereTheHandMayBeMoved) {
  EXPECT_TRUE(is_heard([](const host::server::HandRequest&) {}));
}

TEST_F(Chooser, IsNotHeardWhereNoHandMayBeMoved) { EXPECT_FALSE(is_heard(nullptr)); }

TEST_F(Viewer, ShowsTheOfferedScenesByItsToken) {
  server_.let_choose([](const json&) {}, "[]");
  start();
  EXPECT_EQ(get("/scenes.json").body(), "[]");
  bearer_ = "";
  EXPECT_EQ(get("/scenes.json").result(), http::status::unauthorized);
}

TEST_F(Viewer, OffersNoScenesWithoutALauncher) {
  start();
  EXPECT_EQ(get("/scenes.json").result(), http::status::not_found);
}

}  // namespace tact::test::scene_picker_test
