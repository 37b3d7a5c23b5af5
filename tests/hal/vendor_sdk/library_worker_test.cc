// SPDX-License-Identifier: Apache-2.0
#include "hal/vendor_sdk/library_worker.h"

#include <gtest/gtest.h>

namespace tact::hal::vendor_sdk::library_worker_test {

using namespace std::chrono_literals;
using model::Fault;

constexpr std::int64_t kMs = 1'000'000;
constexpr LibraryForce kPush{.wrench = {.force_N = {0, 0, 2}, .torque_Nm = {}}, .grip_N = 1.0};

/// A library that does all at once, a cycle each millisecond, in the test's own time.
class Worker final : public LibraryWorker {
 public:
  Worker() : LibraryWorker(kMs, 1000.0) {}
  using LibraryWorker::cycle_ended;
  using LibraryWorker::cycles_ended;
  using LibraryWorker::expect_threads;
  using LibraryWorker::keep;
  using LibraryWorker::powered_for_sure;
  using LibraryWorker::thread_ends;

  bool on = false, switches = true, closed = false;
  std::int64_t now_ns = 1000 * kMs;
  double grip_N = 0.0;  // of the last cycle

  void want(bool powered) { commands().write({kPush, now_ns, powered}); }
  /// The force up of the next cycle; -1 when the forces do not switch.
  double cycle_N() {
    now_ns += kMs;
    const auto force = next_force(now_ns);
    publish({.position_m = {}, .orientation = {}, .stamp_ns = now_ns});
    if (force) grip_N = force->grip_N;
    return force ? force->wrench.force_N.z : -1.0;
  }
  bool follows() {
    LibraryPose pose;
    return poses().read(pose) && pose.follows_commands;
  }
  void arm() {
    for (int i = 0; i < 4; ++i) want(true), cycle_N();
  }

 private:
  bool switch_forces(bool wanted) override {
    on = wanted;
    return switches;
  }
  void close() override { closed = true; }
  std::string cause_text() const override {
    return first_cause().fault == Fault::kNone ? "" : "it failed";
  }
};

TEST(LibraryWorker, TheForcesComeThroughTwoMillisecondsOfZero) {
  Worker worker;
  EXPECT_EQ(worker.cycle_N(), 0.0);
  EXPECT_FALSE(worker.on) << "no force was permitted";
  worker.want(true);
  EXPECT_EQ(worker.cycle_N(), 0.0);
  EXPECT_TRUE(worker.on);
  EXPECT_FALSE(worker.follows());
  EXPECT_EQ(worker.cycle_N(), 0.0);
  EXPECT_EQ(worker.grip_N, 0.0);
  EXPECT_EQ(worker.cycle_N(), 2.0);
  EXPECT_EQ(worker.grip_N, 1.0) << "the fingers with the hand";
  EXPECT_TRUE(worker.follows());
}

TEST(LibraryWorker, WithoutPowerTheForcesGoOffAndComeBackThroughZero) {
  Worker worker;
  worker.arm();
  worker.want(false);
  EXPECT_EQ(worker.cycle_N(), 0.0);
  EXPECT_EQ(worker.grip_N, 0.0);
  EXPECT_FALSE(worker.on);
  worker.want(true);
  EXPECT_EQ(worker.cycle_N(), 0.0);
  EXPECT_EQ(worker.cycle_N(), 0.0);
  worker.want(true);
  EXPECT_EQ(worker.cycle_N(), 2.0);
}

TEST(LibraryWorker, ACommandLivesFiveMillisecondsAndTheForcesAHundred) {
  Worker worker;
  worker.arm();
  worker.want(true);
  for (int ms = 1; ms <= 5; ++ms) EXPECT_EQ(worker.cycle_N(), 2.0) << ms;
  for (int ms = 6; ms <= 100; ++ms) EXPECT_EQ(worker.cycle_N(), 0.0) << ms;
  EXPECT_TRUE(worker.on);
  EXPECT_EQ(worker.cycle_N(), 0.0);
  EXPECT_FALSE(worker.on);
}

TEST(LibraryWorker, ForcesThatDoNotSwitchAreReported) {
  Worker worker;
  worker.switches = false;
  worker.want(true);
  EXPECT_EQ(worker.cycle_N(), -1.0);
}

TEST(LibraryWorker, TheForcesAreOnForSureAfterAHundredMilliseconds) {
  Worker worker;
  for (int ms = 0; ms < 101; ++ms) worker.want(true), worker.cycle_N();
  EXPECT_FALSE(worker.powered_for_sure());
  worker.want(true), worker.cycle_N();
  EXPECT_TRUE(worker.powered_for_sure());
  worker.want(false), worker.cycle_N();
  EXPECT_FALSE(worker.powered_for_sure());
}

TEST(LibraryWorker, TheFirstFaultIsKept) {
  Worker worker;
  EXPECT_EQ(worker.fault_text(worker.now_ns), "");
  worker.keep({.fault = Fault::kForceOff, .kind = 3, .code = 0x0203});
  worker.keep({.fault = Fault::kDeviceFailed, .kind = 1, .code = 7});
  EXPECT_EQ(worker.first_cause().fault, Fault::kForceOff);
  EXPECT_EQ(worker.first_cause().kind, 3);
  EXPECT_EQ(worker.first_cause().code, 0x0203);
}

TEST(LibraryWorker, ALibraryWithoutACycleForTwentyMillisecondsMayStillPush) {
  Worker worker;
  EXPECT_EQ(worker.fault_text(worker.now_ns), "") << "none was due";
  worker.cycle_ended(worker.now_ns);
  EXPECT_EQ(worker.fault_text(worker.now_ns + 20 * kMs), "");
  const std::string said = worker.fault_text(worker.now_ns + 21 * kMs);
  EXPECT_EQ(said,
            "the library has made no call for more than 20 ms: the device may still push; switch "
            "its supply off");
  worker.keep({.fault = Fault::kDeviceFailed, .kind = 1, .code = 7});
  EXPECT_EQ(worker.fault_text(worker.now_ns + 21 * kMs), "it failed; " + said) << "both are true";
  worker.cycles_ended();
  EXPECT_EQ(worker.fault_text(worker.now_ns + 21 * kMs), "it failed")
      << "forces off, nothing is due";
}

TEST(LibraryWorker, AStopClosesWhatHasReturnedAndNothingElse) {
  Worker worker;
  worker.expect_threads(1);
  EXPECT_FALSE(worker.stop(3ms));
  EXPECT_FALSE(worker.closed);
  worker.thread_ends();
  EXPECT_TRUE(worker.stop(3ms));
  EXPECT_TRUE(worker.closed);
}

}  // namespace tact::hal::vendor_sdk::library_worker_test
