// SPDX-License-Identifier: Apache-2.0
// law_contract.h - the theorems that every force law must satisfy, from one line each:
//
//     TEST(RhombusChain, KeepsTheLawContract) { check_law_contract(make_law(1.0, 1.0, 1.0)); }
//
// Force is the slope of energy; a closed stroke never returns energy, at any speed; rest stays at
// rest; the force grows with depth; the profile starts at the depth, decays and ends at zero; NaN
// gives zero force; nothing uses the heap. Dimensions: check_dimensions rescales metre, kilogram
// and second.
//
// A law that cannot pull (range().pull_m = 0) has to prove these for presses only, and that it
// has no force outside the surface.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "model/law/law.h"
#include "tests/support/no_alloc.h"

namespace tact::tests {

inline std::vector<double> depths_across(const model::law::LawRange& range, int count) {
  std::vector<double> depths_m;
  for (int i = 0; i <= count; ++i)
    depths_m.push_back(0.9 * (range.pull_m + (range.press_m - range.pull_m) * i / count));
  return depths_m;
}

inline void check_force_is_slope_of_energy(const model::law::Law& law) {
  const double step_m = 1e-6 * law.range().press_m;
  for (const double d : depths_across(law.range(), 40)) {
    if (law.range().pull_m == 0.0 && d < step_m) continue;  // no slope across the surface
    const auto ahead = law.respond(d + step_m), behind = law.respond(d - step_m);
    const auto here = law.respond(d);
    const double scale_N = std::abs(law.respond(law.range().press_m).force_N);
    EXPECT_NEAR((ahead.energy_J - behind.energy_J) / (2.0 * step_m), here.force_N, 1e-6 * scale_N);
    EXPECT_NEAR((ahead.force_N - behind.force_N) / (2.0 * step_m), here.stiffness_N_per_m,
                1e-4 * std::abs(here.stiffness_N_per_m) + 1e-6 * scale_N / law.range().press_m);
  }
}

inline void check_closed_stroke_returns_no_energy(const model::law::Law& law) {
  // Trapezoid rule over press, release, pull, release: a hold rule would make energy by itself.
  const int steps = 4000;
  const double scale_J = law.respond(0.9 * law.range().press_m).energy_J;
  double work_J = 0.0, before_m = 0.0;
  model::law::LawResponse before = law.respond(0.0);
  for (int i = 1; i <= steps; ++i) {
    const double phase = 2.0 * std::numbers::pi * i / steps;
    const double wave = std::sin(phase);
    const double d = 0.9 * wave * (wave > 0.0 ? law.range().press_m : -law.range().pull_m);
    const model::law::LawResponse at = law.respond(d);
    work_J += 0.5 * (at.force_N + before.force_N) * (d - before_m);
    EXPECT_NEAR(at.energy_J, work_J, 1e-4 * scale_J) << "what went in is stored, at " << d << " m";
    before = at;
    before_m = d;
  }
  EXPECT_NEAR(work_J, 0.0, 1e-5 * scale_J);
}

inline void check_rest_and_growth(const model::law::Law& law) {
  EXPECT_EQ(law.respond(0.0).force_N, 0.0);
  EXPECT_EQ(law.respond(0.0).energy_J, 0.0);
  double before_N = -std::numeric_limits<double>::infinity();
  for (const double d : depths_across(law.range(), 200)) {
    const double force_N = law.respond(d).force_N;
    EXPECT_GT(force_N, before_N) << "at depth " << d << " m";
    EXPECT_GE(law.respond(d).energy_J, 0.0);
    EXPECT_GE(force_N * d, 0.0) << "a press pushes out, a pull pulls in";
    before_N = force_N;
  }
}

inline void check_outside(const model::law::Law& law) {
  if (law.range().pull_m < 0.0) return;
  EXPECT_EQ(law.range().pull_m, 0.0);
  for (const double share : {-1e-9, -0.5, -10.0}) {
    const auto outside = law.respond(share * law.range().press_m);
    EXPECT_EQ(outside.status, model::law::LawStatus::kNoContact);
    EXPECT_EQ(outside.force_N, 0.0);
    EXPECT_EQ(outside.stiffness_N_per_m, 0.0);
    EXPECT_EQ(outside.energy_J, 0.0);
    std::vector<double> ring_m(64, -1.0);
    const std::size_t count = law.profile(share * law.range().press_m, ring_m);
    for (std::size_t j = 0; j < count; ++j) EXPECT_EQ(ring_m[j], 0.0);
  }
}

inline void check_profile(const model::law::Law& law) {
  for (const double d : depths_across(law.range(), 10)) {
    std::vector<double> ring_m(64, -1.0);
    const std::size_t count = law.profile(d, ring_m);
    ASSERT_GE(count, 2u);
    EXPECT_NEAR(ring_m[0], d, 1e-9 * law.range().press_m);
    EXPECT_NEAR(ring_m[count - 1], 0.0, 1e-12);
    for (std::size_t j = 1; j < count; ++j)
      EXPECT_LE(std::abs(ring_m[j]), std::abs(ring_m[j - 1]) + 1e-15) << "decays outward";
    std::vector<double> near_m(64);
    const double step_m = 1e-6 * law.range().press_m;
    law.profile(d + step_m, near_m);
    for (std::size_t j = 0; j < count; ++j)
      EXPECT_NEAR(near_m[j], ring_m[j], 2.0 * step_m) << "no jump with depth";
  }
  EXPECT_GT(law.ring_pitch_m(), 0.0);
}

inline void check_bad_depths(const model::law::Law& law) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const double d : {std::nan(""), kInf, -kInf}) {
    EXPECT_EQ(law.respond(d).force_N, 0.0);
    EXPECT_EQ(law.respond(d).status, model::law::LawStatus::kInvalid);
  }
  const auto beyond = law.respond(10.0 * law.range().press_m);
  EXPECT_EQ(beyond.status, model::law::LawStatus::kSaturated);
  EXPECT_TRUE(std::isfinite(beyond.force_N));
}

/// LW-3, for any speed: in every step of a stroke the damping takes energy, so that the stroke
/// gives back no more than it took; what is not held never pulls.
inline void check_damping_takes_energy(const model::law::Law& law) {
  const model::law::LawRange range = law.range();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const double d : {std::nan(""), kInf, -kInf, range.pull_m, -1e-9 * range.press_m, 0.0})
    EXPECT_EQ(law.damping_Ns_per_m(d), 0.0) << d;
  const int steps = 2000;
  for (const double duration_s : {1e-3, 0.1, 10.0})
    for (const bool held : {false, true}) {
      const double low_m = held ? 0.9 * range.pull_m : 0.0;
      const double high_m = 1.2 * range.press_m;
      double before_m = low_m, taken_J = 0.0;
      for (int i = 1; i <= steps; ++i) {
        const double turn = static_cast<double>(i) / steps;  // three presses, each faster
        const double wave = 0.5 - 0.5 * std::cos(6.0 * std::numbers::pi * turn * turn);
        const double d = low_m + wave * (high_m - low_m);
        const double speed_mps = (d - before_m) * steps / duration_s;
        const double force_N = law.respond(d).force_N, b = law.damping_Ns_per_m(d);
        const double added_N = model::law::resistance_N(b, speed_mps, force_N, held);
        EXPECT_GE(b, 0.0) << d;
        EXPECT_GE(added_N * (d - before_m), 0.0) << "at " << d << " m, " << speed_mps << " m/s";
        EXPECT_TRUE(held || force_N + added_N >= std::min(force_N, 0.0)) << "glue at " << d;
        EXPECT_TRUE(b > 0.0 || added_N == 0.0);
        taken_J += added_N * (d - before_m);
        before_m = d;
      }
      EXPECT_EQ(taken_J > 0.0, law.damping_Ns_per_m(0.5 * range.press_m) > 0.0);
    }
}

inline void check_law_contract(const model::law::Law& law) {
  check_force_is_slope_of_energy(law);
  check_closed_stroke_returns_no_energy(law);
  check_rest_and_growth(law);
  check_outside(law);
  check_profile(law);
  check_bad_depths(law);
  check_damping_takes_energy(law);
  const NoAlloc guard;
  for (int i = -10; i <= 10; ++i) (void)law.respond(i * 1e-3), (void)law.damping_Ns_per_m(i * 1e-3);
  EXPECT_EQ(guard.calls(), 0u);
}

/// `make(m, kg, s)` builds the law with its parameters in rescaled units: a right formula only
/// rescales its result.
inline void check_dimensions(
    const std::function<std::unique_ptr<model::law::Law>(double m, double kg, double s)>& make) {
  const double m = 1e3, kg = 7.0, s = 0.3;
  const auto plain = make(1.0, 1.0, 1.0), scaled = make(m, kg, s);
  for (const double d : depths_across(plain->range(), 9)) {
    const auto a = plain->respond(d), b = scaled->respond(d * m);
    EXPECT_NEAR(b.force_N, a.force_N * kg * m / (s * s), 1e-9 * std::abs(b.force_N) + 1e-12);
    EXPECT_NEAR(b.energy_J, a.energy_J * kg * m * m / (s * s), 1e-9 * std::abs(b.energy_J) + 1e-9);
    EXPECT_NEAR(b.stiffness_N_per_m, a.stiffness_N_per_m * kg / (s * s),
                1e-9 * std::abs(b.stiffness_N_per_m));
    const double damping = scaled->damping_Ns_per_m(d * m);
    EXPECT_NEAR(damping, plain->damping_Ns_per_m(d) * kg / s, 1e-9 * damping);
  }
  EXPECT_NEAR(scaled->ring_pitch_m(), plain->ring_pitch_m() * m, 1e-9);
}

}  // namespace tact::tests
