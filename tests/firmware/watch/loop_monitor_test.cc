// SPDX-License-Identifier: Apache-2.0
// What the watch above a loop sees and does: stalls, calls that hang, a loop that never sleeps.
#include "firmware/watch/loop_monitor.h"

#include <gtest/gtest.h>

#include "firmware/telemetry/telemetry.h"
#include "firmware/watch/runaway.h"
#include "tests/support/monitored_loop.h"

namespace tact::firmware::watch::loop_watch_test {

constexpr std::int64_t kSecond = 1000 * kMs;

// A clock whose sleep is none: the loop never gives its core back.
class SleeplessClock final : public loop::Clock {
 public:
  std::int64_t now_ns() RT_SAFE override { return real_.now_ns(); }
  void sleep_until_ns(std::int64_t) RT_SAFE override {}

 private:
  loop::MonotonicClock real_;
};

TEST(StallDetector, FindsAStallWithinTwentyFivePeriodsAndNoneBeforeTwenty) {
  StallDetector watch(kMs, /*hard_real_time=*/true);
  loop::Progress progress;
  progress.tick();
  ASSERT_EQ(watch.step(progress), model::Fault::kNone) << "this tick is news";
  int checks = 1;  // the tick may be as old as one check
  while (watch.step(progress) == model::Fault::kNone) ASSERT_LT(++checks, 100);
  EXPECT_GE(checks * watch.check_ns(), 20 * kMs);
  EXPECT_LE((checks + 1) * watch.check_ns(), 25 * kMs);
  EXPECT_EQ(watch.longest_ns(), 25 * kMs);
  EXPECT_LE(StallDetector(kMs, false).longest_ns(), 255 * kMs) << "a stock kernel stalls by itself";
  EXPECT_GE(StallDetector(kMs / 4, false).longest_ns(), 250 * kMs) << "at any rate";
}

TEST(StallDetector, NamesWhoseCallDidNotComeBack) {
  const auto found_at = [](loop::Callee callee) {
    StallDetector watch(kMs, /*hard_real_time=*/true);
    loop::Progress progress;
    progress.tick();
    progress.enter(callee);
    for (int i = 0; i < 10; ++i) watch.step(progress);
    return watch.step(progress);
  };
  EXPECT_EQ(found_at(loop::Callee::kOwn), model::Fault::kLoopStalled);
  EXPECT_EQ(found_at(loop::Callee::kDevice), model::Fault::kDeviceStalled);
  EXPECT_EQ(found_at(loop::Callee::kLines), model::Fault::kLinesLost);
}

TEST(StallDetector, BearsALoopThatHasNotBegunOrIsOver) {
  StallDetector watch(kMs, /*hard_real_time=*/true);
  loop::Progress progress;
  for (int i = 0; i < 100; ++i) ASSERT_EQ(watch.step(progress), model::Fault::kNone);
  progress.tick();
  progress.end();
  for (int i = 0; i < 100; ++i) ASSERT_EQ(watch.step(progress), model::Fault::kNone);
}

TEST(StallDetector, ASlowLoopThatTicksIsNotStalled) {
  StallDetector watch(kMs, /*hard_real_time=*/true);
  loop::Progress progress;
  for (int i = 0; i < 400; ++i) {
    if (i % 4 == 0) progress.tick();  // every 20 ms
    ASSERT_EQ(watch.step(progress), model::Fault::kNone);
  }
}

TEST_F(MonitoredLoop, ADeviceThatHangsLosesTheEnableLineAndThenTheForce) {
  ASSERT_FALSE(watch.start({}));
  start();
  EXPECT_EQ(lines.drops.load(), 0) << "nothing to find yet";
  device.asleep.store(true);
  ASSERT_TRUE(soon([this] { return lines.drops.load() > 2; }))
      << "by the watch alone, again and again";
  EXPECT_EQ(requests.fault.load(), model::Fault::kDeviceStalled);
  device.asleep.store(false);
  const std::uint64_t before = loop->progress().ticks();
  ASSERT_TRUE(soon([&] { return loop->progress().ticks() > before + 5; }));
  requests.ask(loop::Request::kReset);  // not even the operator brings it back
  usleep(20'000);
  finish();
  loop::TickRecord record;
  bool back = false;
  while (ring->pop(record)) {
    if (record.tick < before) continue;
    back = true;
    EXPECT_EQ(record.output.fault, model::Fault::kDeviceStalled)
        << "from the first tick that came back";
    EXPECT_EQ(record.output.written, model::Wrench{});
  }
  EXPECT_TRUE(back);
  EXPECT_FALSE(device.permitted);
}

TEST_F(MonitoredLoop, AGuardianThatIsLostTakesTheForceAndTheEnableLine) {
  std::atomic<bool> lost{false};
  LoopMonitor beside(StallDetector(kMs, false), loop->progress(), requests, lines,
                     {.is_lost = &lost});
  ASSERT_FALSE(beside.start({}));
  start();
  EXPECT_EQ(requests.fault.load(), model::Fault::kNone);
  lost.store(true);
  ASSERT_TRUE(soon([this] { return lines.drops.load() > 0; }));
  const std::uint64_t before = loop->progress().ticks();
  ASSERT_TRUE(soon([&] { return loop->progress().ticks() > before + 5; }));
  finish();
  loop::TickRecord record;
  while (ring->pop(record)) {
  }
  EXPECT_EQ(record.output.fault, model::Fault::kGuardianLost);
  EXPECT_EQ(record.output.written, model::Wrench{});
}

TEST_F(MonitoredLoop, AGuardianThatIsHeldIsLost) {
  const std::atomic<bool> lost{false};
  std::atomic<std::uint64_t> own{0}, its{1};
  LoopMonitor beside(StallDetector(kMs, false), loop->progress(), requests, lines,
                     {.is_lost = &lost, .own_count = &own, .its_count = &its});
  for (int check = 0; check < 1000; ++check) {
    if (check % 50 == 0) ++its;  // every 250 ms
    beside.check();
  }
  EXPECT_EQ(requests.fault.load(), model::Fault::kNone);
  EXPECT_EQ(own.load(), 1000u);
  for (int check = 0; check <= 120; ++check) beside.check();
  EXPECT_EQ(requests.fault.load(), model::Fault::kGuardianLost);
  EXPECT_GT(lines.drops.load(), 0);
  beside.stop();
  EXPECT_EQ(own.load(), 0u) << "no thread is watched when the loop has ended";
}

TEST(SuspendDetector, SeesEachSuspensionOnce) {
  SuspendDetector detector;
  constexpr std::int64_t kHour_ns = 3600 * model::kSecond_ns;
  EXPECT_FALSE(detector.step(kHour_ns)) << "before the start";
  EXPECT_FALSE(detector.step(kHour_ns + 1000));
  EXPECT_TRUE(detector.step(2 * kHour_ns));
  EXPECT_FALSE(detector.step(2 * kHour_ns));
}

TEST_F(MonitoredLoop, ALoopThatNeverSleepsEndsWithZeroForce) {
  SleeplessClock sleepless;
  loop.emplace(loop::LoopSettings{.period_ns = kMs}, device, lines, controller, sleepless, requests,
               *ring);
  std::atomic<bool> allowed{false};
  const RunawayGuard guard(requests);
  thread = std::thread([&] {
    become_real_time(allowed);
    const std::int64_t start_ns = clock.now_ns();
    while (loop->may_run() && clock.now_ns() - start_ns < 5 * kSecond) loop->step();
    loop->release_device();
    pc::leave_rt_thread();
  });
  thread.join();
  if (!allowed) GTEST_SKIP() << "needs the right to real-time priority 1";
  EXPECT_TRUE(requests.stop.load());
  EXPECT_EQ(requests.fault.load(), model::Fault::kLoopRanAway);
  EXPECT_EQ(device.last, model::Wrench{});
}

TEST_F(MonitoredLoop, ABusyCallThatNeverReturnsLosesTheEnableLine) {
  std::atomic<bool> allowed{false};
  const RunawayGuard guard(requests);
  ASSERT_FALSE(watch.start({}));
  start([&allowed] { become_real_time(allowed); }, [] { pc::leave_rt_thread(); });
  if (!allowed) GTEST_SKIP() << "needs the right to real-time priority 1";
  device.busy.store(true);
  ASSERT_TRUE(soon([this] { return lines.drops.load() > 0; }));
  EXPECT_EQ(requests.fault.load(), model::Fault::kLoopRanAway) << "50 ms come before 250";
  EXPECT_TRUE(requests.stop.load()) << "it is asked to leave";
  device.busy.store(false);
  finish();
  EXPECT_EQ(device.last, model::Wrench{});
}

TEST(Runaway, ThreadThatSleepsBrieflyIsNotARunaway) {
  loop::Requests requests;
  const RunawayGuard guard(requests, 20'000);
  std::thread([] {
    const sched_param lowest{.sched_priority = 1};
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &lowest);
    loop::MonotonicClock clock;
    for (int i = 0; i < 20; ++i) {
      for (const std::int64_t end_ns = clock.now_ns() + 5 * kMs; clock.now_ns() < end_ns;) {
      }
      clock.sleep_until_ns(clock.now_ns() + kMs / 2);
    }
  }).join();
  EXPECT_EQ(requests.fault.load(), model::Fault::kNone);
  EXPECT_FALSE(requests.stop.load());
}

TEST(WatchReport, AFaultOfTheWatchIsShownAlthoughTheLoopGivesNoTicks) {
  const model::scene::Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  const auto ring = std::make_unique<loop::TickRing>();
  const auto shapes = std::make_unique<loop::ShapeSlot>();
  std::atomic<model::Fault> found{model::Fault::kNone};
  telemetry::Telemetry telemetry(
      *ring, telemetry::FrameBuilder(tissue->law().contact_law(), *shapes, false),
      telemetry::FramePace{}, telemetry::Sinks{}, &found);
  loop::TickRecord record;
  record.tick = 7;
  record.output.state = loop::State::kArmed;
  ring->push(record);
  telemetry.drain();
  telemetry.publish();
  EXPECT_EQ(telemetry.newest_frame().state, loop::State::kArmed);
  found.store(model::Fault::kLoopStalled);
  telemetry.publish();
  EXPECT_EQ(telemetry.newest_frame().fault, 120);
  EXPECT_EQ(telemetry.newest_frame().state, loop::State::kStopped);
  EXPECT_EQ(telemetry.newest_frame().tick, 7u);
}

}  // namespace tact::firmware::watch::loop_watch_test
