// A case of tact-limits on a device that is not simulated: the watch above the loop is there, too.
#include "tools/limits/case_run.h"

#include <gtest/gtest.h>

#include "tests/watched_loop.h"

namespace tact::tools {
namespace {

/// The first case of the plan, which pushes for a second.
class OnARealDevice : public testing::Test {
 protected:
  ~OnARealDevice() override {
    device.asleep.store(false);
    if (playing.joinable()) playing.join();
  }
  void play() {
    playing = std::thread([this] { finished.store(run.play()); });
  }
  static bool soon(const std::function<bool()>& what) {
    for (int i = 0; i < 20'000 && !what(); ++i) usleep(1000);
    return what();
  }

  model::Scene scene = tests::make_plate_scene();
  firmware::HangingDevice device;
  firmware::EnableLine lines;
  LimitsBench bench{.scene = scene,
                    .limits = scene.limits,
                    .hard_real_time = false,
                    .device = &device,
                    .lines = &lines,
                    .gate_limits = nullptr};
  CaseRun run{all_cases().front(), bench};
  std::thread playing;
  std::atomic<bool> finished{false};
};

TEST_F(OnARealDevice, ACallThatHangsCostsTheEnableLineAndStopsTheCase) {
  play();
  usleep(300'000);
  device.asleep.store(true);
  EXPECT_TRUE(soon([this] { return lines.drops.load() > 0; })) << "nobody watches this loop";
  device.asleep.store(false);
  playing.join();
  ASSERT_FALSE(run.rows().empty());
  EXPECT_EQ(run.rows().back().fault, Fault::kDeviceStalled);
  EXPECT_EQ(norm(run.rows().back().written_N), 0.0);
}

TEST_F(OnARealDevice, ACaseWithoutTroubleKeepsItsEnableLine) {
  play();
  playing.join();
  EXPECT_TRUE(finished.load());
  EXPECT_EQ(lines.drops.load(), 0);
  EXPECT_GT(run.rows().size(), 900u);
}

}  // namespace
}  // namespace tact::tools
