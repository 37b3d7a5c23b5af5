// SPDX-License-Identifier: Apache-2.0
#include "model/springs/integrators.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/no_alloc.h"

namespace tact::model::springs::integrators_test {

constexpr Oscillator kCanonical{
    .mass_kg = 1.0, .damping_Ns_per_m = 1.2, .stiffness_N_per_m = 4.0, .force_N = 0.5};

/// Error of the position after 1 s.
double error_m(const Method& method, int steps) {
  const OscillatorState start{0.3, 1.0};
  OscillatorState at = start;
  for (int i = 0; i < steps; ++i) at = step(kCanonical, at, method, 1.0 / steps);
  return std::abs(at.position_m - exact(kCanonical, start, 1.0).position_m);
}

TEST(Integrators, MatchPenAndPaper) {
  // m = 1, c = 1.2, k = 4, f = 0.5, x = 0.3, v = 1, h = 0.1:  a = 0.5 - 1.2 - 1.2 = -1.9
  const OscillatorState s{0.3, 1.0};
  const auto at = [&s](Integrator integrator) {
    return step(kCanonical, s, {.integrator = integrator, .alpha = 0.5}, 0.1);
  };
  EXPECT_NEAR(at(Integrator::kExplicitEuler).position_m, 0.4, 1e-15);
  EXPECT_NEAR(at(Integrator::kExplicitEuler).velocity_mps, 0.81, 1e-15);
  EXPECT_NEAR(at(Integrator::kImprovedEuler).position_m, 0.381, 1e-15);
  // x* = 0.35, v* = 0.905: a* = 0.5 - 1.4 - 1.086 = -1.986
  EXPECT_NEAR(at(Integrator::kMidpointAveraging).velocity_mps, 0.8014, 1e-15);
  EXPECT_NEAR(at(Integrator::kMidpointAveraging).position_m, 0.39007, 1e-15);
  EXPECT_NEAR(at(Integrator::kRk2).position_m, 0.3905, 1e-15);
  // v+ = (1 + 0.1 (0.5 - 1.2)) / (1 + 0.12 + 0.04) = 0.93 / 1.16
  EXPECT_NEAR(at(Integrator::kImplicitEuler).velocity_mps, 0.93 / 1.16, 1e-15);
}

TEST(Integrators, ConvergeWithTheirOrder) {
  const auto order = [](Integrator integrator, double alpha) {
    const Method method{.integrator = integrator, .alpha = alpha};
    return std::log2(error_m(method, 200) / error_m(method, 400));
  };
  EXPECT_NEAR(order(Integrator::kExplicitEuler, 0.5), 1.0, 0.1);
  EXPECT_NEAR(order(Integrator::kImprovedEuler, 0.5), 1.0, 0.1);
  EXPECT_NEAR(order(Integrator::kImplicitEuler, 0.5), 1.0, 0.1);
  EXPECT_NEAR(order(Integrator::kMidpointAveraging, 0.5), 2.0, 0.1);
  EXPECT_NEAR(order(Integrator::kMidpointAveraging, 0.375), 1.0, 0.1);
  EXPECT_NEAR(order(Integrator::kMidpointAveraging, 0.625), 1.0, 0.1);
  EXPECT_NEAR(order(Integrator::kRk2, 0.5), 2.0, 0.1);
  EXPECT_NEAR(order(Integrator::kRk4, 0.5), 4.0, 0.1);
}

TEST(Integrators, ExactMotionSolvesItsEquationAtAnyDamping) {
  for (const double c : {0.0, 1.2, 4.0, 12.0}) {
    for (const double k : {0.0, 4.0}) {
      const Oscillator o{1.0, c, k, 0.5};
      const OscillatorState start{0.3, 1.0};
      const double e = 1e-5;
      for (const double t : {0.1, 1.0, 3.0}) {
        const OscillatorState at = exact(o, start, t);
        const OscillatorState ahead = exact(o, start, t + e), behind = exact(o, start, t - e);
        EXPECT_NEAR((ahead.position_m - behind.position_m) / (2 * e), at.velocity_mps, 1e-8);
        EXPECT_NEAR((ahead.velocity_mps - behind.velocity_mps) / (2 * e),
                    0.5 - c * at.velocity_mps - k * at.position_m, 1e-7);
      }
      EXPECT_NEAR(exact(o, start, 0.0).position_m, 0.3, 1e-15);
    }
  }
}

TEST(Integrators, InvalidMassStepOrStateIsRefused) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const auto& entry : kIntegratorNames) {
    const Method method{.integrator = entry.integrator};
    EXPECT_EQ(step({}, {}, method, 0.1).status, law::LawStatus::kInvalid) << "no mass";
    for (const double bad : {kNaN, kInf, -kInf, 0.0, -1.0})
      EXPECT_EQ(step(kCanonical, {}, method, bad).status, law::LawStatus::kInvalid);
    for (const double bad : {kNaN, kInf}) {
      EXPECT_EQ(step(kCanonical, {bad, 0.0}, method, 0.1).status, law::LawStatus::kInvalid);
      EXPECT_EQ(step(kCanonical, {0.0, bad}, method, 0.1).velocity_mps, 0.0);
    }
  }
}

TEST(Integrators, LeaveTheHeapAlone) {
  const tests::NoAlloc guard;
  OscillatorState at{0.3, 1.0};
  for (const auto& entry : kIntegratorNames)
    at = step(kCanonical, at, {.integrator = entry.integrator}, 0.1);
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::model::springs::integrators_test
