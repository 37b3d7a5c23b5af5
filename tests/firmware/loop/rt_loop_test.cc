// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/rt_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "firmware/loop/release_schedule.h"
#include "tests/support/no_alloc.h"
#include "tests/support/puppet_loop.h"

namespace tact::firmware::loop::rt_loop_test {

using RtLoopTest = PuppetLoop;

TEST_F(RtLoopTest, RendersThePlateThroughTheGate) {
  press();
  EXPECT_NEAR(device.last.force_N.z, tissue->law().curve()->respond(0.003).force_N, 0.01);
  EXPECT_EQ(newest().output.state, State::kArmed);
}

TEST_F(RtLoopTest, TheDeviceCatchesUpOnceBeforeTheFirstTick) {
  run_ticks(3);
  EXPECT_EQ(device.catch_ups, 1);
  EXPECT_TRUE(device.caught_up_first);
}

TEST_F(RtLoopTest, GivesNoForceUntilArmed) {
  device.height_m = 0.006;
  run_ticks(5);
  for (; device.height_m > 0.001; device.height_m -= 0.0001) loop.step();
  EXPECT_EQ(device.last, model::Wrench{});
  EXPECT_EQ(newest().output.limit, Fault::kNotArmed);
}

TEST_F(RtLoopTest, ADeviceThatWakesSlowlyIsNotLost) {
  device.silent = true;
  run_ticks(100);
  EXPECT_EQ(newest().output.fault, Fault::kNone);
  device.silent = false;
  requests.arm_at_start.store(true);
  run_ticks(3);
  EXPECT_EQ(newest().output.state, State::kArmed);
}

TEST_F(RtLoopTest, LetsGoAtEveryKindOfEnd) {
  press();
  EXPECT_GT(device.last.force_N.z, 0.05);
  EXPECT_TRUE(loop.progress().running());
  requests.stop.store(true);
  loop.run();
  EXPECT_EQ(device.last, model::Wrench{});
  EXPECT_FALSE(loop.progress().running()) << "the watch has nothing left to watch";
}

TEST_F(RtLoopTest, AZeroThatDoesNotReachTheDeviceAtTheEndIsAFault) {
  for (const bool of_device : {true, false}) {
    requests.fault.store(Fault::kNone);
    press();
    (of_device ? device.write_fault : lines.write_fault) = Fault::kDeviceFailed;
    loop.release_device();
    EXPECT_EQ(requests.fault.load(), Fault::kDeviceFailed);
    device.write_fault = lines.write_fault = Fault::kNone;
  }
}

TEST_F(RtLoopTest, AFaultOfTheLastTicksWriteIsNotForgotten) {
  press();
  device.write_fault = Fault::kDeviceFailed;
  run_ticks(1);
  device.write_fault = Fault::kNone;
  loop.release_device();
  EXPECT_EQ(requests.fault.load(), Fault::kDeviceFailed);
}

TEST_F(RtLoopTest, TicksKeepTheReleaseScheduleOfTheClock) {
  for (int i = 0; i < 3; ++i) {
    run_ticks(1);
    const std::int64_t due_ns = newest().due_ns;
    EXPECT_GT(due_ns, 0);
    EXPECT_EQ(due_ns, next_deadline_ns(due_ns, 1'000'000));
  }
}

TEST_F(RtLoopTest, ALateTickSkipsWholePeriodsOfTheReleaseSchedule) {
  run_ticks(10);
  const std::int64_t phase_ns = newest().due_ns % 1'000'000;
  device.slow_ns = 3'400'000;  // eats three whole periods and a part
  run_ticks(1);
  run_ticks(1);
  const TickRecord after = newest();
  EXPECT_EQ(after.due_ns % 1'000'000, phase_ns);
  EXPECT_EQ(after.late_ticks, 1u);
  EXPECT_EQ(after.skipped_ticks, 3u);
  EXPECT_EQ(loop.statistics().ticks + loop.statistics().skipped_ticks, 15u);
}

TEST_F(RtLoopTest, TheDeviceLivesThroughSkippedPeriodsToo) {
  run_ticks(10);
  device.slow_ns = 3'400'000;
  run_ticks(1);
  EXPECT_NEAR(device.elapsed_s, 0.014, 1e-9);
}

TEST_F(RtLoopTest, LetsGoWhenTheDeviceIsLost) {
  press();
  device.silent = true;
  run_ticks(12);
  EXPECT_NEAR(norm(device.last.force_N), 0.0, 1e-9)
      << "ramped down within 10 ms of the second miss";
  EXPECT_EQ(newest().output.state, State::kArmed);
  run_ticks(8);
  EXPECT_EQ(newest().output.fault, Fault::kDeviceLost);
  device.silent = false;
  run_ticks(50);
  EXPECT_EQ(device.last, model::Wrench{}) << "a fault stays latched";
}

TEST_F(RtLoopTest, LetsGoAtOnceWhenTheDeviceFails) {
  press();
  device.fault = Fault::kDeviceFailed;
  run_ticks(1);
  EXPECT_EQ(device.last, model::Wrench{});
  EXPECT_EQ(newest().output.fault, Fault::kDeviceFailed);
}

TEST_F(RtLoopTest, AFailedWriteStopsInTheNextTick) {
  press();
  device.write_fault = Fault::kDeviceFailed;
  run_ticks(2);
  EXPECT_EQ(newest().output.state, State::kStopped);
  EXPECT_EQ(device.last, model::Wrench{});
}

TEST_F(RtLoopTest, ASampleThatIsNotANumberStopsInTheSameTick) {
  press();
  device.height_m = std::nan("");
  run_ticks(1);
  EXPECT_EQ(device.last, model::Wrench{});
  EXPECT_EQ(newest().output.fault, Fault::kSampleNotFinite);
}

TEST_F(RtLoopTest, AFullRingDropsRecordsAndChangesNothingElse) {
  press();
  const model::Wrench before = device.last;
  run_ticks(10000);  // the ring is not emptied
  EXPECT_GT(ring->dropped(), 0u);
  EXPECT_NEAR(device.last.force_N.z, before.force_N.z, 1e-9);
  EXPECT_EQ(loop.statistics().late_ticks, 0u);
}

TEST_F(RtLoopTest, LeavesTheHeapAlone) {
  press();
  const tests::NoAlloc guard;
  run_ticks(2000);
  EXPECT_EQ(guard.calls(), 0u);
}

TEST_F(RtLoopTest, StopsAfterTheAskedTicks) {
  RtLoop short_loop({.period_ns = 1'000'000, .max_ticks = 7}, device, lines, controller, clock,
                    requests, *ring);
  short_loop.run();
  EXPECT_EQ(short_loop.statistics().ticks, 7u);
}

TEST_F(RtLoopTest, SkippedPeriodsCountInTheAskedTime) {
  RtLoop timed({.period_ns = 1'000'000, .max_periods = 50}, device, lines, controller, clock,
               requests, *ring);
  while (timed.may_run()) {
    device.slow_ns = 9'500'000;  // ten periods each, nine of them skipped
    timed.step();
  }
  EXPECT_EQ(timed.statistics().ticks, 5u);
  EXPECT_EQ(timed.statistics().skipped_ticks, 45u);
}

TEST_F(RtLoopTest, AStallOfTwentyPeriodsEndsTheForce) {
  press();
  device.slow_ns = 20'500'000;
  run_ticks(2);
  EXPECT_EQ(newest().input.skipped_periods, 20u);
  EXPECT_EQ(device.last, model::Wrench{});
  run_ticks(50);
  EXPECT_EQ(newest().output.fault, Fault::kLoopLate) << "latched";
  EXPECT_EQ(device.last, model::Wrench{});
}

TEST_F(RtLoopTest, AClockStepBackCausesNoExcessForceAndNoCatchUp) {
  press();
  run_ticks(1);
  TickRecord before = newest();
  for (int i = 0; i < 50; ++i) {
    device.slow_ns = -5'300'000;
    run_ticks(1);
    const TickRecord now = newest();
    EXPECT_TRUE(is_finite(device.last.force_N));
    EXPECT_LE(norm(device.last.force_N), scene.limits.force_N);
    EXPECT_EQ(now.due_ns, before.due_ns + 1'000'000) << "one period on, as ever";
    EXPECT_EQ(now.skipped_ticks, before.skipped_ticks);
    EXPECT_EQ(now.output.state, State::kArmed);
    before = now;
  }
}

TEST_F(RtLoopTest, AClockThatStepsBackLetsNoForceChangeFasterThanItsSlew) {
  model::Limits slow = scene.limits;
  slow.force_N = 0.5;
  slow.slew_N_per_s = 20.0;
  Controller careful(tissue->contact_scene(), gate::Gate(slow, 0.001, 1.0),
                     /*hard_real_time=*/true);
  RtLoop back({.period_ns = 1'000'000}, device, lines, careful, clock, requests, *ring);
  device.height_m = 0.006;
  requests.arm_at_start.store(true);
  for (int i = 0; i < 600; ++i) back.step();
  for (; device.height_m > 0.001; device.height_m -= 0.00005) back.step();
  double most_N = 0.0;
  for (int i = 0; i < 15; ++i) {
    const model::Vec3 held_N = device.last.force_N;
    device.height_m = i % 2 == 0 ? 0.0 : 0.001;  // 1 mm deeper, 1 mm back: further than the slew
    device.slow_ns = -5'300'000;
    back.step();
    most_N = std::max(most_N, norm(device.last.force_N - held_N));
    EXPECT_EQ(newest().output.state, State::kArmed);
  }
  EXPECT_LE(most_N, slow.slew_N_per_s * 0.001 + 1e-12);
  EXPECT_GT(most_N, 0.5 * slow.slew_N_per_s * 0.001) << "the slew was in question";
}

TEST_F(RtLoopTest, ALoopThatIsLateInEveryTickIsStopped) {
  press();
  for (int i = 0; i < 21; ++i) {
    device.slow_ns = 1'100'000;
    loop.step();
  }
  EXPECT_EQ(newest().output.fault, Fault::kLoopLate);
  EXPECT_EQ(device.last, model::Wrench{});
}

TEST(SphereContacts, ACopyHasTheSpheresThatExistAndNoOther) {
  std::array<model::contact::SphereContact, model::contact::kMaxSpheres + 1> sphere_contact;
  for (std::size_t i = 0; i < sphere_contact.size(); ++i)
    sphere_contact[i].depth_m = static_cast<double>(i + 1);
  SphereContacts two;
  two.assign(std::span(sphere_contact).first(2));
  const SphereContacts copy(two);
  SphereContacts assigned;
  assigned.assign(std::span(sphere_contact).first(4));
  assigned = copy;
  ASSERT_EQ(assigned.all().size(), 2u);
  EXPECT_EQ(assigned.all()[1].depth_m, 2.0);
  assigned.assign(sphere_contact);
  EXPECT_EQ(assigned.all().size(), model::contact::kMaxSpheres);
  assigned = SphereContacts();
  EXPECT_TRUE(assigned.all().empty());
}

TEST(MarkedTime, IsTheClocksBetweenItsReadings) {
  MarkedTime time;
  time.set(1'000'000, 50'000'000);
  time.set(2'000'000, 53'000'000);  // three marks a nanosecond
  EXPECT_EQ(time.at_ns(53'000'000), 2'000'000);
  EXPECT_EQ(time.at_ns(53'003'000), 2'001'000);
  time.set(2'000'000, 53'006'000);  // a clock that stops, and one that runs back
  time.set(1'500'000, 56'000'000);
  EXPECT_EQ(time.at_ns(56'003'000), 1'501'000) << "the rate of before";
  time.set(2'500'000, 1'000);  // a counter that began again
  EXPECT_EQ(time.at_ns(4'000), 2'501'000);
}

TEST(MarkedTime, OfThisPCRunsWithItsClock) {
  MonotonicClock clock;
  MarkedTime time;
  time.set(clock.now_ns(), clock.mark());
  const std::int64_t start_ns = clock.now_ns();
  clock.sleep_until_ns(start_ns + 100'000'000);
  time.set(clock.now_ns(), clock.mark());
  clock.sleep_until_ns(start_ns + 200'000'000);
  const std::int64_t before_ns = clock.now_ns();
  const std::int64_t by_marks_ns = time.at_ns(clock.mark());
  const std::int64_t after_ns = clock.now_ns();
  EXPECT_GT(by_marks_ns, before_ns - 50'000'000);  // half of it: a PC may stop between two readings
  EXPECT_LT(by_marks_ns, after_ns + 50'000'000);
}

}  // namespace tact::firmware::loop::rt_loop_test
