// SPDX-License-Identifier: Apache-2.0
// Cases of tact-limits on a device that is not simulated: what guards tactd's loop guards theirs.
#include "tools/limits/real_device/guarded_play.h"

#include <gtest/gtest.h>

#include "firmware/watch/call_filter.h"
#include "tests/support/monitored_loop.h"
#include "tools/limits/verdict/verdict.h"

namespace tact::tools::limits::guarded_play_test {

/// The first case of the plan, which pushes for a second, twice.
class OnARealDevice : public testing::Test {
 protected:
  ~OnARealDevice() override { end(); }
  void play(firmware::watch::CallFilter* filter = nullptr) {
    playing = std::thread([this, filter] {
      costs = play_guarded(runs, bench, filter,
                           [this](std::size_t now, std::size_t) { done.store(now); });
    });
  }
  void end() {
    device.asleep.store(false);
    device.busy.store(false);
    if (playing.joinable()) playing.join();
  }
  static bool soon(const std::function<bool()>& what) {
    for (int i = 0; i < 20'000 && !what(); ++i) usleep(1000);
    return what();
  }
  bool dropped() {
    return soon([this] { return lines.drops.load() > 0; });
  }
  void expect_stopped_by(Fault fault) {
    EXPECT_EQ(requests.fault.load(), fault);
    ASSERT_FALSE(runs[0]->rows().empty());
    EXPECT_EQ(runs[0]->rows().back().fault, fault);
    EXPECT_EQ(norm(runs[0]->rows().back().written_N), 0.0);
    EXPECT_TRUE(runs[1]->rows().empty()) << "nothing pushes after it";
    EXPECT_EQ(runs[1]->refused(), fault);
    EXPECT_FALSE(check_case(*runs[1]).passed());
  }

  model::scene::Scene scene = tests::make_plate_scene();
  firmware::HangingDevice device;
  firmware::EnableLine lines;
  firmware::loop::Requests requests;
  LimitsBench bench{.scene = scene,
                    .limits = scene.limits,
                    .hard_real_time = false,
                    .device = &device,
                    .lines = &lines,
                    .requests = &requests,
                    .gate_limits = nullptr};
  Runs runs = [this] {
    Runs two;
    for (int i = 0; i < 2; ++i)
      two.push_back(std::make_unique<CaseRun>(all_cases().front(), bench));
    return two;
  }();
  std::thread playing;
  std::atomic<std::size_t> done{0};
  firmware::run::ThreadCosts costs;
};

TEST_F(OnARealDevice, ACallThatHangsCostsTheEnableLineAndEndsThePlan) {
  play();
  usleep(300'000);
  device.asleep.store(true);
  EXPECT_TRUE(dropped()) << "this loop is not watched";
  end();
  expect_stopped_by(Fault::kDeviceStalled);
}

TEST_F(OnARealDevice, ACallThatNeverComesBackEndsTheProcess) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto hang = [this] {
    alarm(30);  // where nothing else ends it
    play();
    usleep(300'000);
    device.asleep.store(true);
    playing.join();
  };
  EXPECT_EXIT(hang(), testing::ExitedWithCode(1), "tact-limits: a call of the device does not");
}

TEST_F(OnARealDevice, ACallThatKeepsItsCoreBusyIsARunaway) {
  const bool real_time = firmware::pc::probe_rt_threads({}).empty();
  play();
  usleep(300'000);
  device.busy.store(true);
  EXPECT_TRUE(dropped());
  end();
  if (!real_time) GTEST_SKIP() << "needs the right to real-time priority";
  expect_stopped_by(Fault::kLoopRanAway);
}

TEST_F(OnARealDevice, ACallThatIsNotListedEndsThePlan) {
  auto filter =
      firmware::watch::CallFilter::make(device.loop_calls(), lines.loop_calls(), requests);
  if (!filter) GTEST_SKIP() << filter.error().message;
  play(filter->get());
  usleep(300'000);
  device.calls.store(true);
  EXPECT_TRUE(dropped());
  end();
  expect_stopped_by(Fault::kForbiddenCall);
  EXPECT_EQ(device.answer, -1) << "it did not reach the kernel";
  EXPECT_TRUE(costs.call_filter);
}

TEST_F(OnARealDevice, CasesWithoutAFaultKeepTheirEnableLineAndMakeNoCallButSleep) {
  auto filter =
      firmware::watch::CallFilter::make(device.loop_calls(), lines.loop_calls(), requests);
  play(filter ? filter->get() : nullptr);
  playing.join();
  EXPECT_EQ(done.load(), 2u);
  EXPECT_EQ(requests.fault.load(), Fault::kNone) << firmware::watch::refused_call();
  EXPECT_EQ(lines.drops.load(), 0);
  EXPECT_EQ(costs.heap_calls, 0u);
  for (const auto& run : runs) EXPECT_GT(run->rows().size(), 900u);
}

}  // namespace tact::tools::limits::guarded_play_test
