// SPDX-License-Identifier: Apache-2.0
// What stops a loop, and what must happen before anything moves again.
#include <gtest/gtest.h>

#include "tests/support/puppet_loop.h"

namespace tact::firmware::loop::loop_stop_test {

class LoopStop : public PuppetLoop {
 protected:
  /// Of the loop, in the next tick or the one after it.
  std::optional<bool> answer_to(Request request) {
    const std::uint32_t number = requests.ask(request);
    EXPECT_EQ(requests.answer(number), std::nullopt) << "before any tick";
    run_ticks(1);
    if (!requests.answer(number)) run_ticks(1);
    return requests.answer(number);
  }
};

TEST_F(LoopStop, EachRequestHasANumberThatTheLoopEchoesInTheTickThatActs) {
  device.height_m = 0.006;
  run_ticks(5);
  const std::uint32_t first = requests.ask(Request::kArm);
  run_ticks(1);
  EXPECT_EQ(newest().output.state, State::kArmed);
  EXPECT_EQ(requests.answer(first), true);
  const std::uint32_t second = requests.ask(Request::kDisarm);
  EXPECT_NE(second, first);
  EXPECT_EQ(requests.answer(second), std::nullopt);
  run_ticks(1);  // an edge needs a tick without a request before it
  EXPECT_EQ(newest().output.state, State::kArmed);
  run_ticks(1);
  EXPECT_EQ(newest().output.state, State::kReady);
  EXPECT_EQ(requests.answer(second), true);
  const std::uint32_t third = requests.ask(Request::kReset);
  requests.ask(Request::kArm);  // takes its place
  run_ticks(2);
  EXPECT_EQ(requests.answer(third), std::nullopt);
  EXPECT_EQ(newest().output.state, State::kArmed);
}

TEST_F(LoopStop, ARequestThatIsTakenBackIsNotDoneLater) {
  device.height_m = 0.006;
  run_ticks(5);
  requests.ask(Request::kArm);
  requests.take_back();  // the loop stood in between
  run_ticks(5);
  EXPECT_EQ(newest().output.state, State::kReady);
  EXPECT_EQ(requests.refused.load(), 0u);
}

TEST_F(LoopStop, AnOpenEmergencyStopTakesTheForceInTheSameTick) {
  press();
  lines.fault = Fault::kEmergencyStop;
  run_ticks(1);
  EXPECT_EQ(device.last, model::Wrench{});
  EXPECT_EQ(newest().output.fault, Fault::kEmergencyStop);
  EXPECT_FALSE(lines.last.healthy) << "no heartbeat while a fault lasts";
  EXPECT_FALSE(lines.last.armed);
}

TEST_F(LoopStop, AReleasedEmergencyStopMovesNothingWithoutAResetAndAnArmEdge) {
  press();
  lines.fault = Fault::kEmergencyStop;
  run_ticks(1);
  lines.fault = Fault::kNone;
  run_ticks(100);
  EXPECT_EQ(device.last, model::Wrench{});
  EXPECT_EQ(answer_to(Request::kArm), false);
  run_ticks(5);
  EXPECT_EQ(newest().output.state, State::kStopped);
  EXPECT_EQ(answer_to(Request::kReset), true);
  run_ticks(5);
  EXPECT_EQ(newest().output.state, State::kReady);
  EXPECT_EQ(device.last, model::Wrench{});
  EXPECT_TRUE(lines.last.healthy);
}

TEST_F(LoopStop, DisarmingTakesTheForceInTheSameTickAndNoStopComesOfIt) {
  press();
  EXPECT_GT(device.last.force_N.z, 0.05);
  requests.ask(Request::kDisarm);
  run_ticks(1);
  EXPECT_EQ(device.last, model::Wrench{});
  EXPECT_EQ(newest().output.state, State::kReady);
  EXPECT_EQ(newest().output.fault, Fault::kNone);
  EXPECT_TRUE(lines.last.healthy) << "the drives keep their power";
  EXPECT_EQ(answer_to(Request::kArm), true);
  EXPECT_EQ(newest().output.state, State::kArmed);
  EXPECT_LT(device.last.force_N.z, 0.01) << "it ramps up again";
  run_ticks(600);
  EXPECT_GT(device.last.force_N.z, 0.05);
}

TEST_F(LoopStop, ThePermissionGoesBeforeTheForce) {
  press();
  lines.device_writes = &device.writes;
  const int before = device.writes;
  lines.fault = Fault::kLinesDiffer;
  run_ticks(1);
  EXPECT_EQ(lines.writes_of_device_before, before);
  EXPECT_EQ(device.writes, before + 1);
}

TEST_F(LoopStop, AnEnableLineThatFallsAndRisesBringsNoForceBack) {
  press();
  lines.enable = false;  // as after a pause of the heartbeat
  run_ticks(1);
  EXPECT_EQ(device.last, model::Wrench{});
  EXPECT_EQ(newest().output.fault, Fault::kPowerLost);
  lines.enable = true;
  run_ticks(200);
  EXPECT_EQ(device.last, model::Wrench{});
}

TEST_F(LoopStop, ADeviceWithoutPowerReportsWhereItIsAndIsNotArmed) {
  device.can_push = false;
  device.height_m = 0.006;
  requests.arm_at_start.store(true);
  run_ticks(20);
  EXPECT_EQ(newest().output.state, State::kReady);
  device.can_push = true;
  run_ticks(2);
  EXPECT_EQ(newest().output.state, State::kArmed);
}

TEST_F(LoopStop, DisarmingEndsTheArmingByItself) {
  device.can_push = false;
  device.height_m = 0.006;
  requests.arm_at_start.store(true);
  run_ticks(20);
  EXPECT_EQ(answer_to(Request::kDisarm), true);
  EXPECT_EQ(requests.refused.load(), 0u);
  device.can_push = true;
  run_ticks(20);
  EXPECT_EQ(newest().output.state, State::kReady);
  EXPECT_EQ(answer_to(Request::kArm), true) << "by a person, from now on";
}

TEST_F(LoopStop, DisarmingBeforeTheFirstSampleEndsTheArmingByItself) {
  device.silent = true;
  device.height_m = 0.006;
  requests.arm_at_start.store(true);
  run_ticks(5);
  EXPECT_EQ(answer_to(Request::kDisarm), true);
  device.silent = false;
  run_ticks(20);
  EXPECT_EQ(newest().output.state, State::kReady);
}

TEST_F(LoopStop, ARequestThatIsTakenBackIsAnsweredByWhatWasDone) {
  device.height_m = 0.006;
  run_ticks(5);
  const std::uint32_t early = requests.ask(Request::kArm);
  requests.take_back();
  run_ticks(2);
  EXPECT_EQ(requests.answer(early), false) << "not done, and never will be";
  const std::uint32_t late = requests.ask(Request::kArm);
  run_ticks(1);
  requests.take_back();
  run_ticks(5);
  EXPECT_EQ(newest().output.state, State::kArmed);
  EXPECT_EQ(requests.answer(late), true);
}

TEST_F(LoopStop, APersonsRequestThatFindsNoPowerIsRefusedAndNotKept) {
  device.can_push = false;
  device.height_m = 0.006;
  run_ticks(5);
  EXPECT_EQ(answer_to(Request::kArm), false);
  run_ticks(20);
  EXPECT_EQ(requests.refused.load(), 1u);
  device.can_push = true;
  run_ticks(20);
  EXPECT_EQ(newest().output.state, State::kReady);
  EXPECT_EQ(answer_to(Request::kArm), true);
  EXPECT_EQ(newest().output.state, State::kArmed);
  EXPECT_EQ(requests.refused.load(), 1u);
}

TEST_F(LoopStop, ArmingAtTheStartIsNotRepeatedAfterAStop) {
  requests.arm_at_start.store(true);
  lines.fault = Fault::kEmergencyStop;
  run_ticks(3);
  lines.fault = Fault::kNone;
  requests.ask(Request::kReset);
  run_ticks(20);
  EXPECT_EQ(newest().output.state, State::kReady);
}

TEST_F(LoopStop, TheDeviceIsPoweredAsTheLinesSay) {
  lines.enable = false;
  run_ticks(2);
  EXPECT_FALSE(device.permitted);
  lines.enable = true;
  run_ticks(1);
  EXPECT_TRUE(device.permitted);
  requests.stop.store(true);
  loop.run();
  EXPECT_FALSE(device.permitted) << "at every end of the loop";
}

TEST_F(LoopStop, LinesThatCannotBeSetStopInTheNextTick) {
  press();
  lines.write_fault = Fault::kLinesLost;
  run_ticks(2);
  EXPECT_EQ(newest().output.fault, Fault::kLinesLost);
  EXPECT_EQ(device.last, model::Wrench{});
}

TEST_F(LoopStop, ALateTickGetsNoHeartbeat) {
  run_ticks(10);
  EXPECT_TRUE(lines.last.healthy);
  device.slow_ns = 3'400'000;
  run_ticks(2);  // the tick after the late one would vouch for it
  EXPECT_FALSE(lines.last.healthy);
  run_ticks(1);
  EXPECT_TRUE(lines.last.healthy);
}

TEST_F(LoopStop, TheScopeLineIsUpOncePerTick) {
  run_ticks(7);
  EXPECT_EQ(lines.ups, 7);
  EXPECT_EQ(lines.downs, 7);
}

TEST_F(LoopStop, ReportsWhenForceStopped) {
  press();
  const std::int64_t before_ns = clock.now_ns();
  device.silent = true;
  run_ticks(25);
  const StopTimes stop = loop.statistics().stop;
  EXPECT_GT(stop.missed_ns, before_ns);
  EXPECT_LE(stop.missed_ns, before_ns + 1'000'000);
  EXPECT_NEAR(static_cast<double>(stop.fault_ns - stop.missed_ns), 19e6, 1.0) << "20 in a row";
  EXPECT_LE(stop.zero_ns - stop.missed_ns, 11'000'000) << "10 ms from the second";
  EXPECT_GE(stop.zero_ns - stop.missed_ns, 9'000'000) << "a ramp, no step";
}

}  // namespace tact::firmware::loop::loop_stop_test
