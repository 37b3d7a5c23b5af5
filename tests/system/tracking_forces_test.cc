// SPDX-License-Identifier: Apache-2.0
// Tracking is for the eyes: tactd gives the same forces, bit for bit, whether tact-view tracks the
// operator beside it or is absent.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "firmware/run/replay.h"
#include "firmware/telemetry/force_hash.h"
#include "host/record/recording.h"
#include "tests/support/program.h"
#include "tests/support/tracking_views.h"

namespace tact {
namespace {

namespace fs = std::filesystem;
const std::string kScenes = TACT_SOURCE_DIR "/model/scenes/";
const std::string kLiver = kScenes + "liver.toml", kMaintenance = kScenes + "maintenance.toml";
const std::string kTable = "desk.tracking.toml", kTroubled = "troubled.tracking.toml";

class Forces : public ::testing::Test {
 protected:
  Forces() : folder_("/tmp/tact-forces-" + std::to_string(getpid())) {
    fs::create_directory(folder_);
    test::write_file(in("index.html"), "<html>");
    std::string lines;
    const host::tracking::TrackingCamera eye = test::camera("front", host::pose::Pose{});
    std::mt19937 noise(3);
    for (std::uint64_t i = 0; i < 120; ++i) {
      const double time_s = static_cast<double>(i) / 60.0;
      const host::pose::Pose hand{.position_m = {0.1 * std::sin(3.0 * time_s), 0.0, 1.5}};
      lines += test::line_of(test::look(eye, {}, "h", hand, time_s, i, &noise)) + "\n";
    }
    test::write_file(in("a.jsonl"), lines);
    test::write_file(in(kTable), test::description("recording = \"a.jsonl\"", {{"h", "hand"}},
                                                   "[registration]\nposition_m = [0, 0, 0]\n"
                                                   "rotation_wxyz = [1, 0, 0, 0]\n"));
  }
  ~Forces() override {
    end_viewer();
    fs::remove_all(folder_);
  }

  std::string in(const std::string& name) const { return folder_ + "/" + name; }
  std::string bytes(const std::string& name) const {
    std::ifstream file(in(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void tactd(const std::string& arguments) const {
    const tests::Outcome outcome =
        tests::run_program("tactd", arguments + " --no-black-box --socket " + in("t.sock"));
    EXPECT_EQ(outcome.status, 0) << outcome.output;
  }
  /// tact-view with the tracker, in a process of its own, recording.
  void start_viewer(const std::string& recording) { start_viewer(recording, in(kTable)); }
  void start_viewer(const std::string& recording, const std::string& tracking) {
    const std::string program = tests::program_path("tact-view");
    viewer_ = fork();
    if (viewer_ == 0) {
      if (std::freopen(in("ready").c_str(), "w", stdout) == nullptr) _exit(127);
      execl(program.c_str(), "tact-view", "--port", "0", "--page", folder_.c_str(), "--socket",
            in("t.sock").c_str(), "--tracking", tracking.c_str(), "--record", in(recording).c_str(),
            nullptr);
      _exit(127);
    }
    for (int i = 0; i < 2000 && bytes("ready").empty(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_FALSE(bytes("ready").empty());  // now it looks for tactd, four times a second
  }
  void end_viewer() {
    if (viewer_ <= 0) return;
    kill(viewer_, SIGINT);
    waitpid(viewer_, nullptr, 0);
    viewer_ = -1;
    fs::remove(in("ready"));
  }
  /// Frames in which the operator's hand was tracked.
  std::size_t tracked_frames(const std::string& recording) const {
    const host::record::ReadResult read = host::record::read_recording(in(recording));
    EXPECT_EQ(read.damage, "");
    std::size_t out = 0;
    for (const host::tracking::TrackedOperator& seen : read.recording.operators) {
      out += seen[host::tracking::BodyRole::kHand].state == host::tracking::BodyState::kTracked ? 1
                                                                                                : 0;
    }
    return out;
  }

  /// A tracker that in 3.3 s falls silent, freezes, jumps, steps back and sees too little.
  void write_troubled() const {
    std::string lines;
    std::mt19937 noise(4);
    std::uint64_t sequence = 0;
    double time_s = 0.0;
    const auto show = [&](double until_s, double by_m = 0.0, std::size_t points = 8) {
      for (; time_s < until_s; time_s += 1.0 / 60.0) {
        const double x_m = 0.1 * std::sin(3.0 * time_s) + (++sequence % 2 == 0 ? by_m : -by_m);
        const host::pose::Pose hand{.position_m = {x_m, 0.0, 1.5}};
        host::tracking::Observation seen = test::look(test::camera("front", host::pose::Pose{}), {},
                                                      "h", hand, time_s, sequence, &noise);
        seen.points.resize(points);
        lines += test::line_of(seen) + "\n";
      }
    };
    show(0.3);
    time_s = 1.0;  // silent
    show(1.2);
    const std::string last = lines.substr(lines.rfind('\n', lines.size() - 2) + 1);
    for (; time_s < 2.0; time_s += 1.0 / 60.0) {  // frozen: only time and number go on
      lines += fmt::format(R"({{"time_s":{:.6f},"sequence":{})", time_s, ++sequence) +
               last.substr(last.find(",\"camera\""));
    }
    show(2.3);
    show(2.6, 0.4);  // jumps about
    show(2.8);
    show(3.0, 0.0, 3);
    show(3.2);
    time_s = 3.0, sequence -= 60;
    show(3.2);  // came before
    time_s = 3.3, sequence += 120;
    show(3.5);
    test::write_file(in("troubled.jsonl"), lines);
    test::write_file(in(kTroubled),
                     test::description("recording = \"troubled.jsonl\"", {{"h", "hand"}},
                                       "[registration]\nposition_m = [0, 0, 0]\n"
                                       "rotation_wxyz = [1, 0, 0, 0]\n"));
  }

  /// While it was recorded, the tracked hand went through all that can befall it.
  void expect_all_trouble(const std::string& recording) const {
    using enum host::tracking::TrackingTrouble;
    std::set<host::tracking::BodyState> states;
    std::set<host::tracking::TrackingTrouble> troubles;
    for (const host::tracking::TrackedOperator& at :
         host::record::read_recording(in(recording)).recording.operators) {
      states.insert(at[host::tracking::BodyRole::kHand].state);
      troubles.insert(at[host::tracking::BodyRole::kHand].trouble);
    }
    for (const auto state : {host::tracking::BodyState::kTracked, host::tracking::BodyState::kHeld,
                             host::tracking::BodyState::kLost})
      EXPECT_TRUE(states.contains(state)) << "state " << static_cast<int>(state);
    for (const auto trouble : {kNone, kSilent, kTooFewPoints, kJump, kFrozen, kOutOfOrder})
      EXPECT_TRUE(troubles.contains(trouble)) << "trouble " << static_cast<int>(trouble);
  }

  /// Of every tick, what the law wanted and what the device got.
  std::vector<std::uint64_t> forces(const std::string& log) const {
    std::vector<std::uint64_t> out;
    auto reader = firmware::protocol::TickLog::open(in(log));
    EXPECT_TRUE(reader);
    if (!reader) return out;
    for (firmware::protocol::LoggedTick tick; reader->next(tick);) {
      const std::uint64_t wanted =
          firmware::telemetry::hash_wrench(model::kFnvStart, tick.output.wanted);
      out.push_back(firmware::telemetry::hash_wrench(wanted, tick.output.written));
    }
    EXPECT_EQ(reader->damage(), "");
    return out;
  }

  std::string folder_;
  pid_t viewer_ = -1;
};

TEST_F(Forces, FreeRunForcesAreBitEqualWithAndWithoutTracking) {
  // Two minutes of simulated time are seconds of a real one: the viewer meets it.
  const std::string run = kLiver + " --free-run --seconds 120";
  tactd(run + " --no-telemetry --json " + in("alone.json"));
  start_viewer("a.tact");
  tactd(run + " --json " + in("seen.json"));
  end_viewer();
  EXPECT_GT(tracked_frames("a.tact"), 10u);
  const auto alone = nlohmann::json::parse(bytes("alone.json"), nullptr, false);
  const auto seen = nlohmann::json::parse(bytes("seen.json"), nullptr, false);
  EXPECT_EQ(alone["force_hash"], seen["force_hash"]);
  EXPECT_EQ(alone["ticks"], seen["ticks"]);
  EXPECT_FALSE(alone["force_hash"].get<std::string>().empty());
}

TEST_F(Forces, AreTheSameInEveryTickOfTheLogs) {
  const std::string run = kLiver + " --free-run --seconds 120 --record ";
  tactd(run + in("alone.log"));
  // The viewer looks for tactd four times a second, and such a run may last less.
  const auto is_seen = [&] {
    return fs::exists(in("view.tact")) && tracked_frames("view.tact") > 1;
  };
  for (int i = 0; i < 20 && !is_seen(); ++i) {
    for (const char* left : {"view.tact", "seen.log"}) fs::remove(in(left));
    start_viewer("view.tact");
    tactd(run + in("seen.log"));
    end_viewer();
  }
  EXPECT_TRUE(is_seen());
  const std::vector<std::uint64_t> alone = forces("alone.log"), seen = forces("seen.log");
  ASSERT_GT(alone.size(), 30'000u);
  EXPECT_EQ(alone, seen);
  EXPECT_GT(std::set(alone.begin(), alone.end()).size(), 1000u);  // and they are forces
}

TEST_F(Forces, LiveRunForcesAreBitEqualInTheReplay) {
  // What a live run meets depends on the clock; what it answers must depend on nothing else.
  start_viewer("view.tact");
  tactd(kLiver + " --seconds 3 --record " + in("live.log"));
  end_viewer();
  EXPECT_GT(tracked_frames("view.tact"), 30u);
  tactd(kLiver + " --replay " + in("live.log"));
}

TEST_F(Forces, LiveRunForcesWithAFaultyTrackerAreBitEqualInTheReplay) {
  write_troubled();
  start_viewer("view.tact", in(kTroubled));
  tactd(kMaintenance + " --seconds 4.5 --record " + in("live.log"));
  end_viewer();
  expect_all_trouble("view.tact");
  // No viewer now: the run that was tracked through all this gives the same forces again.
  tactd(kMaintenance + " --replay " + in("live.log"));
  const std::vector<std::uint64_t> live = forces("live.log");
  EXPECT_GT(std::set(live.begin(), live.end()).size(), 1000u);
}

TEST_F(Forces, FreeRunForcesAreBitEqualWithAFaultyTracker) {
  // The trouble comes in time of the wall's clock: a quarter of an hour is seconds of it.
  const std::string run = kMaintenance + " --set telemetry.frame_rate_Hz=1 --free-run --seconds ";
  write_troubled();
  const auto begin = std::chrono::steady_clock::now();
  tactd(run + "100 --no-telemetry");
  const std::chrono::duration<double> of_100_s = std::chrono::steady_clock::now() - begin;
  const int seconds = static_cast<int>(std::clamp(100.0 * 7.0 / of_100_s.count(), 300.0, 4000.0));
  const std::string whole = run + std::to_string(seconds);
  start_viewer("view.tact", in(kTroubled));
  tactd(whole + " --json " + in("seen.json"));
  end_viewer();
  expect_all_trouble("view.tact");
  // The viewer met this very run, and most of it.
  const auto seen = nlohmann::json::parse(bytes("seen.json"), nullptr, false);
  const auto ticks = seen["ticks"].get<std::uint64_t>();
  EXPECT_EQ(ticks, 1000u * static_cast<unsigned>(seconds));
  const host::record::Recording met = host::record::read_recording(in("view.tact")).recording;
  ASSERT_FALSE(met.frames.empty());
  EXPECT_LT(met.frames.front().tick, ticks / 4);
  EXPECT_GT(met.frames.back().tick, ticks - ticks / 4);
  EXPECT_LE(met.frames.back().tick, ticks);

  tactd(whole + " --no-telemetry --json " + in("alone.json"));
  const auto alone = nlohmann::json::parse(bytes("alone.json"), nullptr, false);
  EXPECT_EQ(alone["force_hash"], seen["force_hash"]);
  EXPECT_EQ(alone["ticks"], seen["ticks"]);
  EXPECT_FALSE(alone["force_hash"].get<std::string>().empty());
}

}  // namespace
}  // namespace tact
