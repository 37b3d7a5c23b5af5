// SPDX-License-Identifier: Apache-2.0
// From a page's message to the line for the launcher, and what the pages are told of it.
#include "host/server/scene_picker.h"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/support/viewer_fixture.h"

namespace tact::test::scene_picker_test {

using host::server::Link;
using host::server::OfferedScene;

class Picker : public ::testing::Test {
 protected:
  void show(const char* scene, bool is_simulated, Link link = Link::kLive) {
    Hello hello = make_hello(3, 1, 3, 1);
    std::strncpy(hello.scene_name, scene, sizeof hello.scene_name - 1);
    hello.simulated = is_simulated ? 1 : 0;
    view_.begin(hello, TinyMeshes{}.bytes(), link);
    picker_.begin();
  }
  nlohmann::json told() const {
    const auto status = nlohmann::json::parse(*view_.status());
    return status.value("picker", nlohmann::json());
  }
  std::string answer() const { return told().value("answer", "nothing is offered"); }

  host::server::LiveView view_;
  std::vector<std::string> lines_;
  host::server::ScenePicker picker_{
      view_,
      {OfferedScene{
           .name = "heart", .numbers = {{"disc_stack.layers", {1.0, 31.0, true}}}, .told = "{}"},
       OfferedScene{.name = "liver", .numbers = {}, .told = "{}"}},
      [this](const std::string& line) { lines_.push_back(line); }};
};

TEST_F(Picker, HandsAGoodWishOnAndTellsWhenItRuns) {
  show("liver", true);
  EXPECT_EQ(told()["scene"], "liver");
  picker_.ask({"heart", {{"disc_stack.layers", 12.0}}});
  EXPECT_EQ(lines_, std::vector<std::string>{"wish heart disc_stack.layers=12"});
  EXPECT_EQ(told()["asked"], "heart");
  EXPECT_EQ(told()["scene"], "liver") << "it has not come yet";
  show("heart", true);
  EXPECT_EQ(told()["asked"], "");
  EXPECT_EQ(told()["scene"], "heart");
  EXPECT_EQ(told()["set"], nlohmann::json({{"disc_stack.layers", 12.0}}));
}

TEST_F(Picker, HandsOnNothingThatIsNotOffered) {
  show("liver", true);
  picker_.ask({"skin", {}});
  EXPECT_EQ(answer(), "there is no scene \"skin\" here");
  picker_.ask({"heart", {{"disc_stack.layers", 99.0}}});
  EXPECT_NE(answer().find("out of range"), std::string::npos);
  EXPECT_TRUE(lines_.empty());
}

TEST_F(Picker, OffersAndHandsOnNothingWhereTheDeviceIsNotSimulated) {
  show("liver", false);
  EXPECT_TRUE(told().is_null());
  picker_.ask({"heart", {}});
  EXPECT_TRUE(lines_.empty());
}

TEST_F(Picker, HandsOnNothingBeforeATactdIsThere) {
  picker_.ask({"heart", {}});
  EXPECT_TRUE(lines_.empty());
}

TEST_F(Picker, HandsOnOneWishAtATime) {
  show("liver", true);
  picker_.ask({"heart", {}});
  picker_.ask({"liver", {}});
  EXPECT_EQ(lines_.size(), 1u);
  EXPECT_NE(answer().find("is being started"), std::string::npos);
}

TEST_F(Picker, TellsWhyAWishCameToNothingAndHearsTheNext) {
  show("liver", true);
  picker_.ask({"heart", {}});
  picker_.refuse("tactd: too stiff \xff");
  EXPECT_EQ(answer(), "tactd: too stiff \xef\xbf\xbd") << "what is no UTF-8 is replaced";
  EXPECT_EQ(told()["scene"], "liver");
  EXPECT_EQ(told()["asked"], "");
  picker_.ask({"heart", {}});
  EXPECT_EQ(lines_.size(), 2u);
  EXPECT_EQ(answer(), "");
}

/// What a page asks over its WebSocket.
class Chooser : public Viewer {
 protected:
  /// Of a server that gives its pages this right over the hand: is a wish heard?
  bool is_heard(const host::server::MoveHand& move_hand) {
    host::server::ViewerServer server(io_, view_, move_hand);
    server.let_choose([this](const host::server::SceneWish&) { ++wishes_; }, "[]");
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
    socket.write(boost::asio::buffer(std::string_view(R"({"wish":{"scene":"heart"}})")));
    socket.close(websocket::close_code::normal, wrong);  // answered after all before it was taken
    boost::asio::post(io_, [this] { io_.stop(); });      // before its server goes
    thread_.join();
    return wishes_ > 0;
  }
  int wishes_ = 0;
};

TEST_F(Chooser, IsHeardWhereTheHandMayBeMoved) {
  EXPECT_TRUE(is_heard([](const host::server::HandWish&) {}));
}

TEST_F(Chooser, IsNotHeardWhereNoHandMayBeMoved) { EXPECT_FALSE(is_heard(nullptr)); }

TEST_F(Viewer, ShowsTheOfferedScenesByItsToken) {
  server_.let_choose([](const host::server::SceneWish&) {}, "[]");
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
