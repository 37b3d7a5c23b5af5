// SPDX-License-Identifier: Apache-2.0
// The operator through tact-view as a person starts it: live with a description, then from the
// recording of it.
#include <signal.h>

#include "host/figure/figure.h"
#include "tests/support/program.h"
#include "tests/support/tracking_views.h"
#include "tests/support/viewer_fixture.h"

namespace tact::host::operator_program_test {

using Eigen::Vector3d;

class OperatorProgram : public ::testing::Test {
 protected:
  OperatorProgram() : folder_("/tmp/tact-operator-" + std::to_string(getpid())) {
    std::filesystem::create_directory(folder_);
    test::write_file(in("index.html"), "<html>");
    std::string lines;  // a hand that is tracked, and stays
    const tracking::TrackingCamera eye = test::camera("front", pose::Pose{});
    for (std::uint64_t i = 0; i < 120; ++i) {
      const pose::Pose hand{.position_m = {1e-6 * static_cast<double>(i), 0.0, 1.5}};
      lines += test::line_of(test::look(eye, {}, "h", hand, static_cast<double>(i) / 60.0, i));
      lines += "\n";
    }
    test::write_file(in("a.jsonl"), lines);
    test::write_file(in("desk.tracking.toml"),
                     test::description("recording = \"a.jsonl\"", {{"h", "hand"}},
                                       "[operator]\nshoulder_m = [0.55, 0.2, 0.45]\n"));
  }
  ~OperatorProgram() override { std::filesystem::remove_all(folder_); }

  std::string in(const std::string& name) const { return folder_ + "/" + name; }
  /// Runs tact-view beside `world`, which is called every 10 ms until it has seen enough; then
  /// Ctrl-C.
  template <typename World>
  void view(const std::string& arguments, const World& world) {
    std::filesystem::remove(in("ready"));
    std::filesystem::remove(in("process"));
    std::atomic<bool> over = false;
    std::thread program([&] {
      const tests::Outcome outcome = tests::run_command(
          "echo $$ > " + in("process") + "; exec " + tests::program_path("tact-view") +
          " --port 0 --json --page " + folder_ + " " + arguments + " > " + in("ready"));
      EXPECT_EQ(outcome.output, "");
      over = true;
    });
    bool enough = false;
    for (int i = 0; i < 3000 && !over && !enough; ++i) {  // 30 s at most, under any load
      enough = world();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_TRUE(enough);
    pid_t process = 0;
    if (std::ifstream(in("process")) >> process && !over) kill(process, SIGINT);
    program.join();
  }
  /// The shoulder on the page of a running tact-view; none yet: nothing.
  std::optional<Vector3d> reported_shoulder_m() const {
    std::ifstream ready(in("ready"));
    const auto json = nlohmann::json::parse(ready, nullptr, false);
    if (!json.contains("port")) return std::nullopt;
    boost::asio::io_context io;
    test::Socket page(io);
    page.set_option(
        test::websocket::stream_base::decorator([&json](test::websocket::request_type& request) {
          request.set("Origin", "http://localhost:1");
          request.set("Authorization", "Bearer " + json["token"].get<std::string>());
        }));
    test::error_code wrong;
    const auto loopback = boost::asio::ip::make_address("127.0.0.1");
    page.next_layer().connect({loopback, json["port"].get<std::uint16_t>()}, wrong);
    if (!wrong) page.handshake("localhost:1", "/live", wrong);
    for (int i = 0; i < 9 && !wrong; ++i) {
      boost::beast::flat_buffer buffer;
      page.read(buffer, wrong);
      const auto text = boost::beast::buffers_to_string(buffer.data());
      const auto reported = nlohmann::json::parse(text, nullptr, false);
      if (reported.value("kind", "") != "figure") continue;
      const std::size_t k = 3 * static_cast<std::size_t>(figure::FigureJoint::kRightShoulder);
      const auto& at_m = reported["joint_m"];
      return Vector3d(at_m[k], at_m[k + 1], at_m[k + 2]);
    }
    return std::nullopt;
  }

  std::string folder_;
};

TEST_F(OperatorProgram, ShowsTheShoulderOfTheSceneLiveAndFromItsRecording) {
  const Vector3d shoulder_m(0.55, 0.20, 0.45);
  std::optional<Vector3d> again_m;
  test::TelemetrySource source(in("t.sock"));
  record::Frame frame;
  frame.tool_orientation[0] = 1.0f;
  frame.tool_position_m[2] = 0.05f;
  int seen = 0;
  view("--socket " + in("t.sock") + " --tracking " + in("desk.tracking.toml") + " --record " +
           in("a.tact") + " 2> " + in("said"),
       [&] {
         source.accept(test::make_header(3, 1, 3, 1), test::TinyMeshes{}.bytes());
         frame.time_ns = static_cast<std::int64_t>(++frame.tick) * 10'000'000;
         source.send(frame);
         // half a second after it has begun to record
         return std::filesystem::exists(in("a.tact")) && ++seen > 50;
       });
  const record::ReadResult read = host::record::read_recording(in("a.tact"));
  ASSERT_EQ(read.damage, "");
  ASSERT_NE(read.recording.figure_at(0), nullptr);
  EXPECT_LT(
      ((*read.recording.figure_at(0))[figure::FigureJoint::kRightShoulder] - shoulder_m).norm(),
      1e-6);
  view("--open " + in("a.tact"), [&] {
    again_m = reported_shoulder_m();
    return again_m.has_value();
  });
  ASSERT_TRUE(again_m.has_value());
  EXPECT_LT((*again_m - shoulder_m).norm(), 1e-3);
}

}  // namespace tact::host::operator_program_test
