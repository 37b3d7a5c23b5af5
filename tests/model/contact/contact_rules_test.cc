// SPDX-License-Identifier: Apache-2.0
// Each rule of contact on any path lets a right contact pass and sees its own breach.
#include "tests/support/contact_rules.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/support/organs.h"

namespace tact::model::contact::contact_rules_test {

constexpr double kRadius_m = 4_mm, kSlope_N_per_m = 50.0, kRange_m = 12_mm, kLimit_N = 0.6;

/// A box of 40 x 30 x 20 mm with its top at z = 0, and a sphere over the middle of it.
class Rules : public ::testing::Test {
 protected:
  explicit Rules(double friction_ratio = 0.0)
      : rules_(body_, {.radius_m = kRadius_m,
                       .max_slope_N_per_m = kSlope_N_per_m,
                       .limit_N = kLimit_N,
                       .range_m = kRange_m,
                       .friction_ratio = friction_ratio}) {}

  /// The rules that a tick at this height breaks.
  std::string at(double z_m, double force_N, ContactState state, bool is_saturated = false,
                 std::uint32_t periods = 1, bool is_unsettled = false) {
    ContactTick tick{.centre_m = {1_mm, 2_mm, z_m}, .periods = periods, .sphere_contact = {}};
    tick.sphere_contact.state = state;
    tick.sphere_contact.surface_point_m = {1_mm, 2_mm, 0};
    tick.sphere_contact.force_N = {0, 0, force_N};
    tick.is_saturated = is_saturated;
    tick.is_unsettled = is_unsettled;
    std::string broken;
    for (const tests::Breach& breach : rules_.check(tick)) broken += breach.rule;
    return broken;
  }
  /// As a linear law does it, pressed from above.
  std::string right(double z_m) {
    const double depth_m = kRadius_m - z_m;
    if (!(depth_m > 0.0)) return at(z_m, 0.0, ContactState::kFree);
    return at(z_m, kSlope_N_per_m * std::min(depth_m, kRange_m), ContactState::kInContact,
              depth_m > kRange_m);
  }
  std::string right(double from_m, double to_m, double step_m = 0.1_mm) {
    std::string broken;
    const int n = static_cast<int>(std::abs(to_m - from_m) / step_m + 0.5);
    for (int i = 0; i <= n; ++i) broken += right(from_m + (to_m - from_m) * i / n);
    return broken;
  }

  using ContactTick = tests::ContactRules::Tick;
  mesh::SurfaceMesh mesh_ = tests::make_flap(
      {.length_m = 40_mm, .width_m = 30_mm, .thickness_m = 20_mm, .edge_m = 10_mm});
  tests::BruteForce body_{mesh_.vertex_m, mesh_.triangle};
  tests::ContactRules rules_;
};

struct RoughRules : Rules {
  RoughRules() : Rules(0.4) {}
};

TEST_F(Rules, LetAPressPass) {
  EXPECT_EQ(right(10_mm, -15_mm), "");
  EXPECT_EQ(right(-15_mm, 10_mm), "");
  EXPECT_EQ(right(10_mm, -2_mm, 0.5_mm), "");
  EXPECT_EQ(right(-2_mm, 10_mm, 0.5_mm), "");
  EXPECT_EQ(rules_.lags(), 0);
}

TEST_F(Rules, LetAStartInsidePass) {
  for (double z_m = -10_mm; z_m < 3.9_mm; z_m += 0.1_mm)
    ASSERT_EQ(at(z_m, 0.0, ContactState::kInside), "");
  EXPECT_EQ(right(4.1_mm, 10_mm), "");
  EXPECT_EQ(right(10_mm, -5_mm), "");
}

TEST_F(Rules, ASeesForceAndContactOfAStartInside) {
  EXPECT_EQ(at(-5_mm, 0.0, ContactState::kFree), "a");
  EXPECT_EQ(at(-5_mm, 0.0, ContactState::kInside), "");
  EXPECT_EQ(at(3_mm, 1e-9, ContactState::kInside, false, 100), "a");
}

TEST_F(Rules, BSeesForceOutside) {
  EXPECT_EQ(right(10_mm, 4.5_mm), "");
  std::string broken;
  double z_m = 4.5_mm;
  for (; broken.empty() && z_m < 60_mm; z_m += 0.5_mm)
    broken = at(z_m, 1e-7, ContactState::kInContact);
  EXPECT_EQ(broken, "b");
  EXPECT_NEAR(z_m, 4.5_mm + kRange_m + 1_mm, 0.6_mm);
  EXPECT_EQ(rules_.lags(), 1);
}

TEST_F(Rules, BSeesForceThatStaysOutside) {
  EXPECT_EQ(right(10_mm, 5_mm), "");
  int ticks = 0;
  while (at(5_mm, 1e-7, ContactState::kInContact).empty() && ticks < 1000) ++ticks;
  EXPECT_NEAR(ticks, 200, 2);
}

TEST_F(Rules, CSeesForceFarBehindTheBody) {
  EXPECT_EQ(right(10_mm, -24_mm), "");
  std::string broken;
  double z_m = -24_mm;
  for (; broken.empty() && z_m > -80_mm; z_m -= 1_mm) broken = right(z_m);
  EXPECT_EQ(broken, "c");
  EXPECT_NEAR(z_m, -24_mm - 2 * kRange_m, 2_mm);
}

TEST_F(Rules, CSeesForceThatStaysBehindTheBody) {
  EXPECT_EQ(right(10_mm, -25_mm), "");
  int ticks = 0;
  while (right(-25_mm).empty() && ticks < 1000) ++ticks;
  EXPECT_NEAR(ticks, 190, 11);
}

TEST_F(Rules, DSeesAFallThrough) {
  EXPECT_EQ(right(10_mm, 4.1_mm), "");
  EXPECT_EQ(at(2_mm, 0.0, ContactState::kFree), "");  // its centre is outside
  EXPECT_EQ(at(-1_mm, 0.0, ContactState::kFree), "");
  EXPECT_EQ(at(-1.5_mm, 0.0, ContactState::kFree), "");
  EXPECT_EQ(at(-2_mm, 0.0, ContactState::kFree), "d");
}

TEST_F(Rules, DSeesALetGoWithoutCause) {
  EXPECT_EQ(right(10_mm, 3.9_mm), "");
  EXPECT_EQ(at(3.8_mm, 0.0, ContactState::kInside), "d");
}

TEST_F(Rules, ESeesAJump) {
  EXPECT_EQ(right(10_mm, 2_mm), "");
  EXPECT_EQ(at(1.9_mm, 0.16, ContactState::kInContact), "e");
  EXPECT_EQ(at(1.9_mm, 0.158, ContactState::kInContact), "e");  // 2 mN, at rest
}

TEST_F(Rules, ELetsAForceLagAndSeesAJumpAllTheSame) {
  EXPECT_EQ(right(10_mm, 2_mm), "");
  EXPECT_EQ(at(2_mm, 0.105, ContactState::kInContact, false, 1, true), "");
  EXPECT_EQ(at(2_mm, 0.12, ContactState::kInContact, false, 1, true), "e");
}

TEST_F(Rules, ISeesAForceThatLagsForTooLong) {
  EXPECT_EQ(right(10_mm, 2_mm), "");
  int ticks = 0;
  while (at(2_mm, 0.1, ContactState::kInContact, false, 1, true).empty() && ticks < 1000) ++ticks;
  EXPECT_NEAR(ticks, 110, 3);
}

TEST_F(Rules, ELetsASaturatedContactGoOutside) {
  EXPECT_EQ(right(10_mm, -25_mm), "");
  double force_N = kLimit_N;
  for (int i = 0; i < 50; ++i) {
    force_N = std::max(0.0, force_N - kLimit_N / 50.0);
    ASSERT_EQ(at(-25_mm, force_N, ContactState::kInContact, true), "");
  }
  EXPECT_EQ(at(-25_mm, 0.0, ContactState::kFree), "");
}

TEST_F(Rules, FSeesAPullAndNoNumber) {
  EXPECT_EQ(right(10_mm, 3.999_mm), "");
  EXPECT_EQ(at(3.9_mm, -0.01, ContactState::kInContact), "f");
  EXPECT_EQ(at(3.9_mm, std::numeric_limits<double>::quiet_NaN(), ContactState::kInContact), "f");
}

TEST_F(RoughRules, HSeesEnergyGiven) {
  EXPECT_EQ(right(10_mm, 1_mm), "");
  for (double z_m = 1_mm; z_m < 4_mm; z_m += 0.1_mm)
    ASSERT_EQ(at(z_m, 1.2 * kSlope_N_per_m * (4_mm - z_m), ContactState::kInContact), "");
  EXPECT_EQ(right(4.1_mm), "h");
}

}  // namespace tact::model::contact::contact_rules_test
