// SPDX-License-Identifier: Apache-2.0
// The scalar core of the gate over classes of float: zero, denormals, normals, the limit and its
// neighbours, the largest, infinity, NaN. Where one vector comes in: all of them with both signs,
// in every combination; where two do: one of most classes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "firmware/gate/limiter.h"
#include "firmware/gate/ramp_down.h"
#include "firmware/gate/thermal_limit.h"
#include "tests/firmware/gate/number_classes.h"

namespace tact::firmware::gate::gate_scalars_test {

using tests::numbers::all_classes;
using tests::numbers::beside;
using tests::numbers::Doubles;
using tests::numbers::finite_classes;
using tests::numbers::for_each_vector;
using tests::numbers::kInfinity;
using tests::numbers::kLimit;
using tests::numbers::with_signs;
constexpr double kStep = 1.0;

TEST(GateScalars, AShortenedVectorIsFiniteAndNoLongerThanItsLimit) {
  for (const double limit : {0.0, Doubles::denorm_min(), Doubles::min(), 1e-160, kLimit, 1e154})
    for_each_vector(all_classes(), [limit](const Vec3& v) {
      Vec3 out = v;
      const bool cut = limit_magnitude(out, limit);
      ASSERT_TRUE(is_finite(out));
      ASSERT_LE(norm(out), limit) << v.x << ' ' << v.y << ' ' << v.z;
      if (!cut) ASSERT_EQ(out, v);
      ASSERT_EQ(cut, !(norm(v) <= limit));
    });
}

TEST(GateScalars, RoundingLeavesNoVectorAboveItsLimit) {
  // One unit in the last place was left with a room of 4e-16.
  Vec3 found{0x1.0658ed9ae8956p+8, 0x1.3404b145dc9f9p-1, 0x1.d16fbd63475eep+2};
  limit_magnitude(found, 0x1.0ed12f04a2b8ep+1);
  EXPECT_LE(norm(found), 0x1.0ed12f04a2b8ep+1);
  std::mt19937_64 random(15);
  const auto draw = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  for (int i = 0; i < 2'000'000; ++i) {
    const double limit = std::exp2(draw(-20.0, 20.0));
    Vec3 v{draw(0.0, 300.0), draw(0.0, 300.0) * std::exp2(draw(-60.0, 0.0)),
           draw(0.0, 300.0) * std::exp2(draw(-60.0, 0.0))};
    limit_magnitude(v, limit);
    ASSERT_LE(norm(v), limit) << std::hexfloat << v.x << ' ' << v.y << ' ' << v.z;
  }
}

TEST(GateScalars, AnUnsoundLimitLetsNothingThrough) {
  for (const double limit : {-kInfinity, -1.0, Doubles::quiet_NaN()})
    for_each_vector(all_classes(), [limit](const Vec3& v) {
      Vec3 out = v;
      limit_magnitude(out, limit);
      ASSERT_TRUE(is_finite(out));
      ASSERT_LE(norm(out), std::isnan(limit) ? 0.0 : std::abs(limit));
    });
}

TEST(GateScalars, AnApproachStaysWithinItsStepAndItsRadius) {
  constexpr double kRounding = 1e-14;
  // One of each class of a written force, and of each class of what may be wanted.
  const std::vector<double> from{0.0,  Doubles::denorm_min(), -Doubles::min(),
                                 -1.0, beside(4.0, 1),        -4.6};
  for (const double radius : {0.0, Doubles::min(), 1.0, 7.5, beside(kLimit, -1), kLimit})
    for_each_vector(from, [radius](const Vec3& before) {
      if (norm(before) > kLimit) return;
      for_each_vector({0.0, -Doubles::denorm_min(), Doubles::min(), 3.0, -kLimit, 1e154,
                       -Doubles::max(), kInfinity, -kInfinity, Doubles::quiet_NaN()},
                      [radius, &before](const Vec3& wanted) {
                        for (const double shrink : {kStep, 3.0 * kStep}) {
                          Vec3 v = wanted;
                          const bool held = approach(v, before, kStep, shrink, radius);
                          ASSERT_TRUE(is_finite(v));
                          ASSERT_LE(norm(v), kLimit);
                          ASSERT_LE(norm(v - before), shrink + kRounding);
                          ASSERT_LE(norm(v), norm(before) + kStep + kRounding);
                          ASSERT_LE(norm(v), std::fmax(radius, norm(before) - shrink) + kRounding);
                          if (!held) ASSERT_EQ(v, wanted);
                        }
                      });
    });
}

TEST(GateScalars, ATurnWithAShrinkingRadiusKeepsBoth) {
  // From 8 N along x towards 2 N along y: on a straight line |F| would fall by 0.92 a tick.
  Vec3 v{0, 2, 0};
  const Vec3 before{8, 0, 0};
  EXPECT_TRUE(approach(v, before, 1.0, 1.0, 2.0));
  EXPECT_NEAR(norm(v), 7.0, 1e-12);
  EXPECT_NEAR(norm(v - before), 1.0, 1e-12);
}

TEST(GateScalars, OnlyTheEnergySurplusAlongTheMotionIsRemoved) {
  // 3 N and 4 mm are 12 mJ, 5 mJ of them may stay: 1.25 N along x.
  Wrench w{{3, 7, 0}, {}};
  EXPECT_TRUE(limit_surplus(w, {0.004, 0, 0}, {}, 0.005));
  EXPECT_NEAR(w.force_N.x, 1.25, 1e-12);
  EXPECT_EQ(w.force_N.y, 7.0) << "across the motion nothing is taken";
  Wrench against{{-3, 7, 0}, {}};
  EXPECT_FALSE(limit_surplus(against, {0.004, 0, 0}, {}, 0.0)) << "it takes energy";
}

constexpr std::array kMotions{Vec3{1e-3, 0, 0},
                              Vec3{0, -1e-9, 1e-3},
                              Vec3{1e-160, 0, 0},
                              Vec3{0, 1.6e-162, -2.7e-162},  // its square is one denormal, or two
                              Vec3{0, 0, -1e-170},
                              Vec3{1e-3, Doubles::denorm_min(), 0},
                              Vec3{-Doubles::denorm_min(), 0, 0},
                              Vec3{}};

TEST(GateScalars, TakingAlongAMotionNeverLengthensAForceOrATorque) {
  for_each_vector(finite_classes(), [](const Vec3& v) {
    if (norm(v) > 100.0) return;  // the others: below
    for (const Vec3& d : kMotions)
      for (const Vec3& a : kMotions)
        for (const double most : {0.0, 1e-12, 1e-3}) {
          Wrench w{v, -0.1 * v};
          const bool taken = limit_surplus(w, d, a, most);
          ASSERT_TRUE(is_finite(w)) << d.x << ' ' << a.x;
          ASSERT_LE(norm(w.force_N), norm(v) + 1e-12);
          ASSERT_LE(norm(w.torque_Nm), 0.1 * norm(v) + 1e-12);
          const double left =
              std::fmax(dot(w.force_N, d), 0.0) + std::fmax(dot(w.torque_Nm, a), 0.0);
          ASSERT_LE(left, most + 1e-15);
          ASSERT_EQ(taken, !(w == Wrench{v, -0.1 * v})) << "a stage that says so took something";
        }
  });
}

TEST(GateScalars, TheMagnitudeStageLimitsAForceOfAnyClass) {
  for_each_vector(all_classes(), [](const Vec3& v) {
    for (const Vec3& d : kMotions) {
      Wrench w{v, -0.1 * v};
      limit_surplus(w, d, d, 1e-3);
      for (Vec3* out : {&w.force_N, &w.torque_Nm}) {
        limit_magnitude(*out, kLimit);
        ASSERT_TRUE(is_finite(*out));
        ASSERT_LE(norm(*out), kLimit);
      }
    }
  });
}

TEST(GateScalars, AMotionTooSmallToBeSquaredTakesNothingFromAForce) {
  for (const double tiny : {1.6e-162, 1e-170, Doubles::denorm_min()}) {
    Wrench w{{3, 7, 0}, {0.1, 0.2, 0}};
    EXPECT_FALSE(limit_surplus(w, {tiny, 0, 0}, {0, tiny, 0}, 0.0));
    EXPECT_EQ(w, (Wrench{{3, 7, 0}, {0.1, 0.2, 0}}));
  }
  Wrench w{{3, 7, 0}, {0.1, 0.2, 0}};  // beside an ordinary one it does not count either
  EXPECT_TRUE(limit_surplus(w, {1e-170, 0, 0}, {0, 0.01, 0}, 0.001));
  EXPECT_EQ(w.force_N, (Vec3{3, 7, 0}));
  EXPECT_NEAR(w.torque_Nm.y, 0.1, 1e-15) << "1 mJ of 2 may stay";
}

TEST(GateScalars, ARampStaysBetweenShutAndOpen) {
  for (const double dt_s : all_classes())
    for (const bool open : {false, true})
      for (const double level : {0.0, Doubles::denorm_min(), beside(1.0, -1), 1.0}) {
        RampDown ramp(0.01);
        ramp.set(level);
        const double after = ramp.step(open, dt_s);
        ASSERT_GE(after, 0.0);
        ASSERT_LE(after, 1.0);
      }
}

TEST(GateScalars, AThermalLimitIsBetweenContinuousAndPeakHoweverHot) {
  for (const double before : finite_classes())
    for (const double force_N : finite_classes()) {
      ThermalLimit limit(8.0, 4.0, 0.001);
      for (const double held : {before, force_N}) {
        limit.add({held, 0, 0}, 1.0);
        ASSERT_GE(limit.allowed(), 4.0);
        ASSERT_LE(limit.allowed(), 8.0);
      }
    }
}

TEST(GateScalars, AHotMotorIsAllowedItsContinuousForceAColdOneItsPeak) {
  ThermalLimit limit(8.0, 4.0, 0.01);
  EXPECT_EQ(limit.allowed(), 8.0);
  for (int i = 0; i < 55; ++i) limit.add({4, 0, 0}, 1.0);
  // h = 16 (1 - 0.99^55) = 6.79: A^2 = 16 + 6 (16 - 6.79) = 71.2, above the peak's 64
  EXPECT_EQ(limit.allowed(), 8.0);
  for (int i = 0; i < 55; ++i) limit.add({4, 0, 0}, 1.0);
  // h = 16 (1 - 0.99^110) = 10.70: A^2 = 16 + 6 * 5.30 = 47.8
  EXPECT_NEAR(limit.allowed(), 6.91, 0.01);
  for (int i = 0; i < 10000; ++i) limit.add({4, 0, 0}, 1.0);
  EXPECT_NEAR(limit.allowed(), 4.0, 1e-6);
  EXPECT_NEAR(limit.rms(), 4.0, 1e-9);
}

}  // namespace tact::firmware::gate::gate_scalars_test
