// SPDX-License-Identifier: Apache-2.0
// Tangential springs of many spheres: what changed is solved again, and couplings stay bounded.
#include "model/contact/shear.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tact::model::contact::shear_test {

constexpr std::size_t kSpheres = 10;

OwnCompliance own(double m_per_N) {
  return {.m_per_N = {m_per_N, 0.1 * m_per_N, 1.2 * m_per_N}, .least_m_per_N = 0.01};
}

// Ten in a row; each is coupled with all others.
Shear coupled(double at_next_m_per_N) {
  const Axes axes = axes_of({0, 0, 1});
  Shear shear(kSpheres);
  for (std::size_t i = 0; i < kSpheres; ++i) shear.set_own(i, own(0.02));
  for (std::size_t i = 0; i < kSpheres; ++i)
    for (std::size_t j = 0; j < i; ++j)
      shear.couple(i, j, at_next_m_per_N / static_cast<double>(i - j), axes, axes);
  return shear;
}

Shear::Shifts shifts_m(double phase) {
  Shear::Shifts t_m{};
  for (std::size_t i = 0; i < kSpheres; ++i)
    t_m[i] = {1e-3 * std::cos(phase * static_cast<double>(i)),
              1e-3 * std::sin(2.0 + phase * static_cast<double>(i))};
  return t_m;
}

TEST(Shear, AFewStiffenedSpringsAreSolvedAsIfAllWereNew) {
  Shear stepwise = coupled(0.002), again = coupled(0.002);
  stepwise.solve();
  for (const std::size_t i : {3u, 7u}) {
    stepwise.set_own(i, own(0.015));
    again.set_own(i, own(0.015));
  }
  stepwise.solve();
  again.solve();
  for (std::size_t i = 0; i < kSpheres; ++i) {
    const Vec2 f_N = again.force_N(shifts_m(1.3), i);
    EXPECT_GT(norm(f_N), 1e-3) << i;
    EXPECT_NEAR(norm(stepwise.force_N(shifts_m(1.3), i) - f_N), 0.0, 1e-14) << i;
  }
}

// For any couplings, W = sum f_i . t_i / 2 > 0.
TEST(Shear, CouplingsOfManySpheresStayBounded) {
  for (const double wanted_m_per_N : {0.001, 0.01, 1.0, -1.0}) {
    Shear shear = coupled(wanted_m_per_N);
    shear.solve();
    for (double phase = 0.0; phase < 7.0; phase += 0.01) {
      const Shear::Shifts t_m = shifts_m(phase);
      double twice_J = 0.0;
      for (std::size_t i = 0; i < kSpheres; ++i) twice_J += dot(shear.force_N(t_m, i), t_m[i]);
      ASSERT_GT(twice_J, 0.0) << wanted_m_per_N << ", " << phase;
    }
  }
}

}  // namespace tact::model::contact::shear_test
