// SPDX-License-Identifier: Apache-2.0
#include "tools/calibrate/gated_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace tact::tools::calibrate::gated_run_test {

using firmware::loop::SimulatedClock;
using model::Fault;

/// A grip on a support; it reports where it is, and keeps its last command.
class Grip final : public hal::Device {
 public:
  hal::DeviceInfo info() const override {
    return {.name = "grip",
            .max_force_N = 9.0,
            .workspace_radius_m = 0.05,
            .workspace_half_length_m = 0.05,
            .grip = hal::GripKind::kNone};
  }
  Fault read(hal::Sample& sample, std::int64_t now_ns) RT_SAFE override {
    sample.fresh = !silent;
    sample.stamp_ns = now_ns;
    sample.tool.position_m = {0.0, 0.0, height_m};
    return Fault::kNone;
  }
  Fault write(const model::Wrench& wrench) RT_SAFE override {
    up_N[writes++] = wrench.force_N.z;
    return Fault::kNone;
  }
  void permit(bool) RT_SAFE override {}
  bool ready() const RT_SAFE override { return true; }
  void stop() override {}

  bool silent = false;
  double height_m = 0.0;
  std::vector<double> up_N;
  std::size_t writes = 0;
};

struct Bench {
  Grip grip;
  SimulatedClock clock;
  hal::Sample sample;
  int ticks = 0;

  /// Wants this force for so many ticks; `each` is called before every one.
  template <typename Each>
  Fault want(double force_N, int count, Each each) {
    grip.up_N.resize(static_cast<std::size_t>(count) + 1);
    const Fault fault = run_gated(grip, clock, sample, [&](double& up_N) {
      each(ticks);
      up_N = force_N;
      return ++ticks < count;
    });
    grip.up_N.resize(grip.writes);
    return fault;
  }
  double most_N() const { return *std::max_element(grip.up_N.begin(), grip.up_N.end()); }
};

TEST(GatedRun, FiveNewtonBalanceForcePassesTheGateUnchanged) {
  Bench b;
  EXPECT_EQ(b.want(5.0, 1000, [](int) {}), Fault::kNone);
  EXPECT_NEAR(b.most_N(), 5.0, 1e-9);
  EXPECT_EQ(b.grip.up_N.back(), 0.0);
}

TEST(GatedRun, NeverPassesSixNewtonNorJumpsForAnyRequest) {
  Bench b;
  b.want(50.0, 1000, [](int) {});
  EXPECT_LE(b.most_N(), 6.0);
  EXPECT_GT(b.most_N(), 5.9);
  for (std::size_t i = 1; i + 2 < b.grip.up_N.size(); ++i)
    EXPECT_LE(std::abs(b.grip.up_N[i] - b.grip.up_N[i - 1]), 0.1 + 1e-12) << i;
}

TEST(GatedRun, EndsWithoutForceWhenTheDeviceFallsSilent) {
  Bench b;
  EXPECT_EQ(b.want(5.0, 1000, [&b](int tick) { b.grip.silent = tick > 300; }), Fault::kDeviceLost);
  EXPECT_LT(b.ticks, 330);
  EXPECT_EQ(b.grip.up_N.back(), 0.0);
}

TEST(GatedRun, GivesNoForceOutsideTheWorkspace) {
  Bench b;
  b.grip.height_m = 0.2;
  EXPECT_EQ(b.want(5.0, 1000, [](int) {}), Fault::kOutsideWorkspace);
  EXPECT_EQ(b.ticks, 1);
  EXPECT_EQ(b.most_N(), 0.0);
}

TEST(GatedRun, ALateTickKeepsTheGrid) {
  Bench b;
  std::int64_t last_ns = 0;
  b.want(1.0, 20, [&](int tick) {
    if (tick == 10) b.clock.sleep_until_ns(b.clock.now_ns() + 2'500'000);
    last_ns = b.clock.now_ns();
  });
  // 20 ticks; the one that took 2.5 periods has skipped two.
  EXPECT_EQ(last_ns, 22 * kPeriod_ns);
}

TEST(GatedRun, WaitsForADeviceThatIsNotHomedAsLongAsNoForceIsWanted) {
  Bench b;
  b.grip.silent = true;
  EXPECT_EQ(b.want(0.0, 1000, [](int) {}), Fault::kNone);
  EXPECT_EQ(b.ticks, 1000);
}

TEST(GatedRun, NanForceGivesZeroForceAndAFault) {
  Bench b;
  EXPECT_EQ(b.want(std::numeric_limits<double>::quiet_NaN(), 100, [](int) {}),
            Fault::kForceNotFinite);
  EXPECT_EQ(b.most_N(), 0.0);
}

}  // namespace tact::tools::calibrate::gated_run_test
