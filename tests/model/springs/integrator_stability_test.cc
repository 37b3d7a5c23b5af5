// SPDX-License-Identifier: Apache-2.0
#include "model/springs/integrator_stability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace tact::model::springs::integrator_stability_test {

struct Row {
  double zeta;
  std::array<double, 7> z_max;  // explicit, improved, 3/8, 1/2, 5/8, RK2, RK4
};

constexpr std::array<Method, 7> kColumns{{{Integrator::kExplicitEuler},
                                          {Integrator::kImprovedEuler},
                                          {Integrator::kMidpointAveraging, 0.375},
                                          {Integrator::kMidpointAveraging, 0.5},
                                          {Integrator::kMidpointAveraging, 0.625},
                                          {Integrator::kRk2},
                                          {Integrator::kRk4}}};

TEST(IntegratorStability, GivesTheTableOfLimits) {
  const std::vector<Row> table{{0.0, {0.0, 2.0, 0.0, 2.0, 1.789, 0.0, 2.828}},
                               {0.05, {0.1, 1.902, 0.893, 1.912, 1.719, 0.8, 2.910}},
                               {0.2, {0.4, 1.640, 1.964, 1.757, 1.608, 1.394, 2.940}},
                               {0.4, {0.8, 1.354, 1.894, 1.784, 1.693, 1.846, 2.700}},
                               {0.5, {1.0, 1.236, 2.000, 2.000, 1.600, 2.000, 2.623}},
                               {0.7, {1.4, 1.041, 1.905, 1.429, 1.143, 2.180, 2.698}},
                               {1.0, {2.0, 0.828, 1.333, 1.000, 0.800, 2.000, 2.785}},
                               {1.5, {0.764, 0.606, 0.889, 0.667, 0.533, 0.764, 1.064}},
                               {2.0, {0.536, 0.472, 0.667, 0.500, 0.400, 0.536, 0.746}}};
  for (const Row& row : table)
    for (std::size_t i = 0; i < kColumns.size(); ++i)
      EXPECT_NEAR(largest_stable_z(kColumns[i], row.zeta), row.z_max[i], 5.1e-4)
          << "zeta " << row.zeta << ", column " << i;
  EXPECT_TRUE(std::isinf(largest_stable_z({Integrator::kImplicitEuler}, 0.3)));
}

TEST(IntegratorStability, LimitSeparatesStableFromGrowing) {
  for (const Method& method : kColumns) {
    for (double zeta = 0.01; zeta < 3.0; zeta *= 1.17) {
      const double z = largest_stable_z(method, zeta);
      EXPECT_TRUE(is_stable(amplification(method, 0.999 * z, zeta))) << zeta;
      EXPECT_FALSE(is_stable(amplification(method, 1.001 * z, zeta))) << zeta;
      for (int i = 1; i < 20; ++i)
        EXPECT_LT(spectral_radius(amplification(method, 0.0499 * i * z, zeta)), 1.0);
    }
  }
}

TEST(IntegratorStability, MatrixIsOneStepOfTheOscillator) {
  const double h = 0.37, k = 5.1, c = 0.9;
  const double omega = std::sqrt(k), zeta = c / (2.0 * omega);
  std::vector<Method> methods(kColumns.begin(), kColumns.end());
  methods.push_back({Integrator::kImplicitEuler});
  for (const Method& method : methods) {
    const Amplification m = amplification(method, h * omega, zeta);
    const OscillatorState to = step({1.0, c, k, 0.0}, {0.2, -0.7}, method, h);
    EXPECT_NEAR(to.position_m, m[0] * 0.2 + m[1] * h * -0.7, 1e-14);
    EXPECT_NEAR(h * to.velocity_mps, m[2] * 0.2 + m[3] * h * -0.7, 1e-14);
  }
}

TEST(IntegratorStability, RadiusIsTheMeasuredGrowth) {
  // A hundred steps after a hundred: the fast-growing mode alone is left.
  const double h = 0.4, k = 4.0;
  const Method method{Integrator::kMidpointAveraging, 0.375};
  OscillatorState at{1.0, 0.3};
  const auto energy_J = [k](const OscillatorState& s) {
    return 0.5 * (s.velocity_mps * s.velocity_mps + k * s.position_m * s.position_m);
  };
  double first_J = 0.0;
  for (int i = 0; i < 400; ++i) {
    at = step({1.0, 0.0, k, 0.0}, at, method, h);
    if (i == 199) first_J = energy_J(at);
  }
  const double growth = std::pow(energy_J(at) / first_J, 1.0 / 400.0);  // of the amplitude
  EXPECT_NEAR(growth, spectral_radius(amplification(method, h * 2.0, 0.0)), 2e-3);
}

TEST(IntegratorStability, InvalidDampingRatioHasAStabilityLimitOfZero) {
  EXPECT_EQ(largest_stable_z({}, std::nan("")), 0.0);
  EXPECT_EQ(largest_stable_z({}, -0.1), 0.0);
  EXPECT_EQ(largest_stable_z({}, std::numeric_limits<double>::infinity()), 0.0);
  EXPECT_EQ(largest_stable_z({Integrator::kMidpointAveraging, -1.0}, 0.1), 0.0);
}

}  // namespace tact::model::springs::integrator_stability_test
