// SPDX-License-Identifier: Apache-2.0
// The whole viewer but its browser: synthetic telemetry in at a socket, HTTP and WebSocket out.
#include <gtest/gtest.h>

#include "hal/sim/hand_target.h"
#include "tests/support/message.h"
#include "tests/support/viewer_fixture.h"

namespace tact::test::viewer_server_test {

using namespace host;

TEST_F(Viewer, ServesThePageWithItsGuards) {
  start();
  const auto page = get("/");
  EXPECT_EQ(page.result(), http::status::ok);
  EXPECT_EQ(page.body(), "<html>page");
  EXPECT_NE(page["Content-Security-Policy"].find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(page["X-Content-Type-Options"], "nosniff");
  EXPECT_EQ(get("/../../etc/passwd").result(), http::status::not_found);
  EXPECT_EQ(get("/", "evil.example").result(), http::status::forbidden);
}

TEST_F(Viewer, SaysThatItWaitsBeforeTactdIsThere) {
  start();
  EXPECT_EQ(get("/scene.json").result(), http::status::service_unavailable);
  EXPECT_EQ(get("/recording.csv").result(), http::status::service_unavailable);
  Socket socket(client_io_);
  ASSERT_FALSE(open_live(socket, "http://localhost:1"));
  EXPECT_EQ(read(socket)["link"], "waiting");
}

TEST_F(Viewer, RefusesTheWebSocketOfAForeignPage) {
  start();
  Socket foreign(client_io_);
  EXPECT_EQ(open_live(foreign, "http://evil.example"), websocket::error::upgrade_declined);
  Socket none(client_io_);
  EXPECT_EQ(open_live(none, ""), websocket::error::upgrade_declined);
}

class ViewerAt : public Viewer, public ::testing::WithParamInterface<const char*> {};

TEST_P(ViewerAt, ShowsNothingWithoutItsToken) {
  start(GetParam());
  start_source();
  EXPECT_EQ(server_.token().size(), 32u);
  EXPECT_NE(server_.url().find("/#token=" + server_.token()), std::string::npos);
  for (const std::string& wrong : {std::string(), std::string("Bearer wrong")}) {
    bearer_ = wrong;
    EXPECT_EQ(get("/").result(), http::status::ok) << "the page itself is no secret";
    for (const char* path : {"/scene.json", "/mesh.bin", "/recording.csv", "/recording.tactview",
                             "/session", "/live", "/none"}) {
      EXPECT_EQ(get(path).result(), http::status::unauthorized) << path;
      EXPECT_EQ(get(path + ("?token=" + server_.token())).result(), http::status::unauthorized)
          << "an address is kept in histories and logs";
    }
    Socket without(client_io_);
    EXPECT_EQ(open_live(without, "http://localhost:1"), websocket::error::upgrade_declined);
  }
}

// As a browser does, which sends no other header with a WebSocket.
TEST_P(ViewerAt, AWebSocketShowsItsTokenAsASubprotocol) {
  start(GetParam());
  start_source();
  bearer_ = "";
  for (const bool right : {true, false}) {
    protocols_ = "tact, token." + (right ? server_.token() : std::string(32, '0'));
    Socket socket(client_io_);
    EXPECT_EQ(!open_live(socket, "http://localhost:1"), right);
  }
  EXPECT_EQ(get("/session")[http::field::set_cookie], "");
}

INSTANTIATE_TEST_SUITE_P(AnyAddress, ViewerAt, ::testing::Values("127.0.0.1", "0.0.0.0"));

TEST_F(Viewer, PassesSceneMeshesAndFramesOn) {
  start();
  start_source();
  const auto scene = nlohmann::json::parse(get("/scene.json").body(), nullptr, false);
  EXPECT_EQ(scene["organ_vertices"], 3);
  const std::string mesh = get("/mesh.bin").body();
  ASSERT_EQ(mesh.size(), meshes_.size());
  EXPECT_EQ(std::memcmp(mesh.data(), meshes_.data(), mesh.size()), 0);

  Socket socket(client_io_);
  ASSERT_FALSE(open_live(socket, "http://localhost:1"));
  const auto status = read(socket);
  EXPECT_EQ(status["link"], "live");
  EXPECT_EQ(status["scene_number"], 1);
  Frame frame;
  frame.tick = 77;
  source_->send(frame);
  EXPECT_EQ(read(socket)["tick"], 77);
}

TEST_F(Viewer, GivesASlowBrowserTheNewestFrameAndNotTheOldOnes) {
  start();
  start_source();
  Socket socket(client_io_);
  ASSERT_FALSE(open_live(socket, "http://localhost:1"));
  read(socket);
  Frame frame;
  constexpr std::uint64_t kSent = 200;
  for (frame.tick = 1; frame.tick <= kSent; ++frame.tick) {
    source_->send(frame);  // the browser sleeps; no other client waits
    ASSERT_TRUE(wait_until([&] { return frames_ == frame.tick; }));
  }
  std::uint64_t shown = 0;
  for (std::uint64_t i = 1; i <= server::LiveSession::kMaxUnseen; ++i) {
    const std::uint64_t tick = read(socket)["tick"];
    EXPECT_GT(tick, shown);
    shown = tick;
  }
  // It answers for the first time: what comes next is the newest, not number five.
  socket.write(boost::asio::buffer(std::string(R"({"seen":4})")));
  EXPECT_EQ(read(socket)["tick"], kSent);
}

TEST_F(Viewer, KeepsServingWhenBrowsersLeave) {
  start();
  start_source();
  for (int i = 0; i < 5; ++i) {
    Socket socket(client_io_);
    ASSERT_FALSE(open_live(socket, "http://localhost:1"));
    read(socket);
  }
  Frame frame;
  for (frame.tick = 1; frame.tick <= 50; ++frame.tick) {
    source_->send(frame);  // one at a time: the queue of a local socket holds about 40
    ASSERT_TRUE(wait_until([&] { return frames_ == frame.tick; }));
  }
  EXPECT_TRUE(wait_until([this] { return view_.listeners() == 0; }));
}

TEST_F(Viewer, ForgetsABrowserThatSendsTooMuch) {
  start();
  start_source();
  Socket socket(client_io_);
  ASSERT_FALSE(open_live(socket, "http://localhost:1"));
  read(socket);
  EXPECT_TRUE(wait_until([this] { return view_.listeners() == 1; }));
  error_code reset_by_peer;
  socket.write(boost::asio::buffer(std::string(5000, ' ')), reset_by_peer);
  EXPECT_TRUE(wait_until([this] { return view_.listeners() == 0; }));
}

TEST_F(Viewer, SaysThatTactdWentAwayAndFindsItAgain) {
  start();
  start_source();
  Socket socket(client_io_);
  ASSERT_FALSE(open_live(socket, "http://localhost:1"));
  EXPECT_EQ(read(socket)["link"], "live");
  source_.reset();
  EXPECT_EQ(read(socket)["link"], "lost");
  source_ = std::make_unique<TelemetrySource>((folder_ / "t.sock").string());
  for (int i = 0; i < 6000 && !source_->accept(header_, meshes_); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const auto status = read(socket);
  EXPECT_EQ(status["link"], "live");
  EXPECT_EQ(status["scene_number"], 2);
}

TEST_F(Viewer, SeesThatATactdIsPausedAndThatItGoesOn) {
  start();
  start_source();
  Frame frame;
  for (frame.tick = 1; frame.tick <= 40; ++frame.tick) {
    source_->send(frame);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ASSERT_TRUE(wait_until([&] { return frames_ == 40; }));
  EXPECT_TRUE(wait_until([this] { return silences_s_ == std::vector<double>{0.3}; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  source_->send(frame);
  EXPECT_TRUE(wait_until([this] { return silences_s_ == std::vector<double>{0.3, 0.0}; }))
      << "reported once each";
}

TEST_F(Viewer, SaysWhatIsWrongWithTelemetryOfAnotherBuild) {
  start();
  Socket socket(client_io_);
  ASSERT_FALSE(open_live(socket, "http://localhost:1"));
  EXPECT_EQ(read(socket)["link"], "waiting");
  source_ = std::make_unique<TelemetrySource>((folder_ / "t.sock").string());
  source_->first_message = "tactrun2";
  for (int i = 0; i < 6000 && !source_->accept(header_, meshes_); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const std::string detail = read(socket)["detail"];
  EXPECT_NE(detail.find("one build"), std::string::npos) << detail;
}

TEST_F(Viewer, RefusesATriangleThatNamesAMissingVertex) {
  TinyMeshes bad;
  bad.organ_triangle[1] = 3;
  meshes_ = bad.bytes();
  start();
  source_ = std::make_unique<TelemetrySource>((folder_ / "t.sock").string());
  EXPECT_TRUE(wait_until(
      [this] { return view_.status()->find("names vertex 3 of 3") != std::string::npos; }));
  EXPECT_FALSE(view_.has_scene());
}

TEST_F(Viewer, SendsAHandTargetAndNothingElse) {
  const std::string path = (folder_ / "hand.sock").string();
  header_.hand_socket = path;
  const int hand = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(hand, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  start();
  start_source();
  Socket socket(client_io_);
  ASSERT_FALSE(open_live(socket, "http://localhost:1"));
  socket.write(boost::asio::buffer(std::string(R"({"force_N":[9,9,9]})")));
  socket.write(boost::asio::buffer(
      std::string(R"({"hand":{"x_m":0.01,"y_m":0.02,"z_m":0.03,"turn_x_rad":0,"turn_y_rad":0,)"
                  R"("turn_z_rad":0.1,"grip_ratio":0.5}})")));
  hal::sim::HandTarget target;
  ASSERT_EQ(::recv(hand, &target, sizeof target, 0), static_cast<ssize_t>(sizeof target));
  EXPECT_EQ(target.magic, hal::sim::kHandTargetMagic);
  EXPECT_EQ(target.position_m[2], 0.03);
  EXPECT_EQ(target.rotation_rad[2], 0.1);
  EXPECT_EQ(target.grip_ratio, 0.5);
  ::close(hand);
}

TEST_F(Viewer, GivesTheKeptFramesAsATableAndAsARecording) {
  start();
  start_source();
  Frame frame;
  for (frame.tick = 1; frame.tick <= 600; ++frame.tick) {
    source_->send(frame);
    if (frame.tick % 20 == 0)  // more at once than a socket holds are dropped
      ASSERT_TRUE(wait_until([&] { return frames_ == frame.tick; }));
  }
  const std::string table = get("/recording.csv").body();
  EXPECT_TRUE(table.starts_with("# tact frames\n"));
  EXPECT_EQ(
      std::count(table.begin(), table.end(), '\n') - std::count(table.begin(), table.end(), '#'),
      601);
  const auto part = get("/recording.tactview?from_tick=101&to_tick=200");
  EXPECT_EQ(part[http::field::content_disposition], "attachment") << "the page names the file";
  const fs::path file = folder_ / "part.tact";
  std::ofstream(file, std::ios::binary) << part.body();
  const record::ReadResult read = record::read_recording(file);
  EXPECT_EQ(read.damage, "");
  ASSERT_EQ(read.recording.frames.size(), 100u);
  EXPECT_EQ(read.recording.frames.front().tick, 101u);
}

TEST_F(Viewer, SaysThatAPortIsInUse) {
  start();
  server::LiveView view;
  boost::asio::io_context io;
  server::ViewerServer second(io, view, nullptr);
  const std::string wrong =
      tests::message_of(second.open({.port = server_.port(), .page_folder = folder_}));
  EXPECT_NE(wrong.find("in use"), std::string::npos) << wrong;
  EXPECT_NE(tests::message_of(
                second.open({.bind_address = "nonsense", .port = 0, .page_folder = folder_}))
                .find("--bind"),
            std::string::npos);
  EXPECT_NE(tests::message_of(second.open({.port = 0, .page_folder = folder_, .public_url = "lab"}))
                .find("--url"),
            std::string::npos);
}

}  // namespace tact::test::viewer_server_test
