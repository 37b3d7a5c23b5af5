// SPDX-License-Identifier: Apache-2.0
// tact-view --register as a person uses it: made-up telemetry, made-up datagrams, a file at the
// end.
#include "host/run/register_tracker.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "host/tracking/registration.h"
#include "tests/support/mesh_files.h"
#include "tests/support/message.h"
#include "tests/support/program.h"
#include "tests/support/telemetry_source.h"
#include "tests/support/tracking_views.h"

namespace tact::host::run::register_tracker_test {

using tests::message_of;

using boost::asio::ip::udp;
using Eigen::Vector3d;

// The tracker's frame to the device's.
const pose::Pose kTable{.rotation = test::turn(0.5, {0.2, 1.0, 0.4}),
                        .position_m = {0.1, -0.2, -1.9}};
const Vector3d kTip_m(0.1, 0.0, 0.0);
// Places of the device's tool, 15 mm apart and more.
constexpr double kPlaces_m[][3] = {{0, 0, 0},      {.03, 0, 0},      {0, .03, 0},       {0, 0, .03},
                                   {-.03, .02, 0}, {.02, -.03, .02}, {-.02, -.02, -.03}};

class Register : public ::testing::Test {
 protected:
  Register() : folder_("/tmp/tact-register-" + std::to_string(getpid())) {
    std::filesystem::create_directory(folder_);
    boost::asio::io_context io;
    port_ = udp::socket(io, {boost::asio::ip::address_v4::loopback(), 0}).local_endpoint().port();
    test::write_file(tracking(),
                     test::description("udp_port = " + std::to_string(port_), {{"t", "tool"}}));
  }
  ~Register() override { std::filesystem::remove_all(folder_); }

  std::string tracking() const { return folder_ + "/desk.tracking.toml"; }
  std::string written() const { return folder_ + "/desk.registration.toml"; }

  /// The program while the tool goes from place to place; `wrong_m` bends what the tracker sees of
  /// one of them.
  tests::Outcome run(const std::string& arguments, std::size_t places, double wrong_m = 0.0,
                     int most_s = 240) {
    test::TelemetrySource source(folder_ + "/t.sock");
    EXPECT_TRUE(source.ok());
    std::atomic<bool> done = false;
    std::thread world([&] { play(source, places, wrong_m, done); });
    const tests::Outcome outcome =
        // In the foreground: one signal. Else a second one may end the program while it leaves.
        tests::run_command("timeout --foreground --preserve-status -s INT " +
                           std::to_string(most_s) + " " + tests::program_path("tact-view") +
                           " --register --tracking " + tracking() + " --socket " + folder_ +
                           "/t.sock " + arguments);
    done = true;
    world.join();
    return outcome;
  }

  void play(test::TelemetrySource& source, std::size_t places, double wrong_m,
            const std::atomic<bool>& done) const {
    boost::asio::io_context io;
    udp::socket sender(io, udp::v4());
    std::mt19937 noise(1);
    const tracking::TrackingCamera eye = test::camera("front", pose::Pose{});
    const record::RunHeader header = test::make_header(3, 1, 3, 1);
    for (std::uint64_t i = 0; !done;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      if (!source.accept(header, test::TinyMeshes{}.bytes())) continue;
      ++i;
      const std::size_t place = i / 220 % places;  // a place that was missed comes again
      const bool moves = i % 220 < 10;
      const Vector3d tip_m(kPlaces_m[place]);
      record::Frame frame = test::make_frame(0.0f, model::ContactState::kFree);
      for (int axis = 0; axis < 3; ++axis)
        frame.tool_position_m[axis] = static_cast<float>(tip_m[axis]);
      frame.tool_velocity_mps[0] = moves ? 0.1f : 0.001f;
      source.send(frame);
      // kTable (R (tip) + t) = the device's tip
      const Vector3d bent_m = tip_m + (place == 2 ? wrong_m : 0.0) * Vector3d::UnitZ();
      pose::Pose tool{.rotation = test::turn(0.3, {1, 0, 1})};
      tool.position_m =
          kTable.rotation.conjugate() * (bent_m - kTable.position_m) - tool.rotation * kTip_m;
      const std::string line = test::line_of(
          test::look(eye, pose::Pose{}, "t", tool, 0.01 * static_cast<double>(i), i, &noise, 0.01));
      boost::system::error_code lost;
      sender.send_to(boost::asio::buffer(line), {boost::asio::ip::address_v4::loopback(), port_}, 0,
                     lost);
    }
  }

  std::string folder_;
  std::uint16_t port_ = 0;
};

TEST_F(Register, FindsTheTrackerAndWritesItDown) {
  const tests::Outcome outcome = run("--poses 7", 7);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("pose 7 of 7 taken"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("7 poses, residuals 0."), std::string::npos) << outcome.output;
  const auto setup = tracking::load_tracking_setup(tracking());
  ASSERT_EQ(message_of(setup), "");
  EXPECT_EQ(setup->registered_by, written());
  EXPECT_LT(setup->registration.rotation.angularDistance(kTable.rotation), 1e-3);
  const Vector3d tip_m = kTable.rotation.conjugate() * -kTable.position_m;  // at the first place
  EXPECT_LT(to_world(setup->registration, tip_m).norm(), 5e-4);
}

TEST_F(Register, WarnsOfAPoseThatIsFarOffAndNamesIt) {
  const tests::Outcome outcome = run("--poses 7 --json", 7, 0.012);
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  // The third, but where other work took the processor and a place was missed.
  int pose = 0;
  const std::size_t warning = outcome.output.find("warning: pose ");
  ASSERT_NE(warning, std::string::npos) << outcome.output;
  std::sscanf(outcome.output.c_str() + warning, "warning: pose %d", &pose);
  EXPECT_EQ(outcome.output.find(" at (0, 30, 0) mm is off by"),
            warning + ("warning: pose " + std::to_string(pose)).size())
      << outcome.output;
  EXPECT_TRUE(std::filesystem::exists(written()));
  const std::size_t json = outcome.output.find("{\"file\"");
  ASSERT_NE(json, std::string::npos);
  const auto all = nlohmann::json::parse(
      outcome.output.substr(json, outcome.output.find('\n', json) - json), nullptr, false);
  EXPECT_GT(all["largest_m"].get<double>(), tracking::kDoubtful_m);
  const auto residuals_m = all["residuals_m"].get<std::vector<double>>();
  ASSERT_EQ(residuals_m.size(), 7u);
  EXPECT_EQ(std::ranges::max_element(residuals_m) - residuals_m.begin() + 1, pose);
}

TEST_F(Register, WritesNothingFromTooFewPoses) {
  const tests::Outcome outcome = run("--poses 7", 2, 0.0, 10);  // ends with the signal
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("poses are too few"), std::string::npos) << outcome.output;
  EXPECT_FALSE(std::filesystem::exists(written()));
}

TEST_F(Register, NeedsADescriptionWithATool) {
  EXPECT_EQ(tests::run_program("tact-view", "--register").status, 2);
  EXPECT_EQ(tests::run_program("tact-view", "--register --poses 5 --tracking x").status, 2);
}

TEST_F(Register, SaysThatNoBodyIsTheTool) {
  test::write_file(tracking(),
                   test::description("udp_port = " + std::to_string(port_), {{"h", "hand"}}));
  const tests::Outcome outcome =
      tests::run_program("tact-view", "--register --tracking " + tracking());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.output.find("no body has role = \"tool\" and tip_m"), std::string::npos)
      << outcome.output;
}

TEST_F(Register, RefusesADescriptionWhoseOwnRegistrationWouldGoFirst) {
  std::ofstream(tracking(), std::ios::app)
      << "[registration]\nposition_m = [0, 0, 0]\nrotation_wxyz = [1, 0, 0, 0]\n";
  const tests::Outcome outcome = tests::run_command(
      "timeout 20 " + tests::program_path("tact-view") + " --register --tracking " + tracking());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.output.find("has a [registration] of its own"), std::string::npos)
      << outcome.output;
  EXPECT_FALSE(std::filesystem::exists(written()));
}

TEST_F(Register, RefusesARecordingAndLeavesTheOldFileAlone) {
  std::string lines;
  const tracking::TrackingCamera eye = test::camera("front", pose::Pose{});
  for (std::uint64_t i = 0; i < 3; ++i) {
    lines += test::line_of(test::look(eye, pose::Pose{}, "t", pose::Pose{.position_m = {0, 0, 2}},
                                      static_cast<double>(i), i)) +
             "\n";
  }
  test::write_file(folder_ + "/a.jsonl", lines);
  test::write_file(tracking(), test::description("recording = \"a.jsonl\"", {{"t", "tool"}}));
  const std::string old = "[registration]\nposition_m = [0, 0, 0]\nrotation_wxyz = [1, 0, 0, 0]\n";
  test::write_file(written(), old);
  const tests::Outcome outcome = run("--poses 7", 7, 0.0, 5);
  EXPECT_EQ(outcome.status, 2) << outcome.output;
  EXPECT_NE(outcome.output.find("registration needs udp_port"), std::string::npos)
      << outcome.output;
  EXPECT_EQ(tests::read_text(written()), old);
  EXPECT_FALSE(std::filesystem::exists(written() + ".bak"));
}

}  // namespace tact::host::run::register_tracker_test
