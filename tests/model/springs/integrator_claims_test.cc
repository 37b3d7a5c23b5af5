// SPDX-License-Identifier: Apache-2.0
// What the source of midpoint-averaging claims and what does not hold (MA-19, X18 to X20).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/springs/integrator_stability.h"

namespace tact::model::springs::integrator_claims_test {

constexpr Method kExplicit{Integrator::kExplicitEuler};
constexpr Method kImproved{Integrator::kImprovedEuler};
constexpr Method kImplicit{Integrator::kImplicitEuler};
constexpr Method kThreeEighths{Integrator::kMidpointAveraging, 0.375};
constexpr Method kHalf{Integrator::kMidpointAveraging, 0.5};
constexpr Method kFiveEighths{Integrator::kMidpointAveraging, 0.625};

struct RmsError {
  double position_m = 0.0, velocity_mps = 0.0;
};

/// RMS over 10 s against the exact motion.
RmsError rms(const Oscillator& o, const OscillatorState& start, const Method& method, double h) {
  const auto steps = static_cast<int>(std::lround(10.0 / h));
  OscillatorState at = start;
  RmsError sum;
  for (int i = 1; i <= steps; ++i) {
    at = step(o, at, method, h);
    const OscillatorState truth = exact(o, start, h * i);
    sum.position_m += std::pow(at.position_m - truth.position_m, 2);
    sum.velocity_mps += std::pow(at.velocity_mps - truth.velocity_mps, 2);
  }
  return {std::sqrt(sum.position_m / steps), std::sqrt(sum.velocity_mps / steps)};
}

/// omega in rad/s, unit mass.
Oscillator oscillator(double omega, double zeta) {
  return {
      .mass_kg = 1.0, .damping_Ns_per_m = 2.0 * zeta * omega, .stiffness_N_per_m = omega * omega};
}

constexpr OscillatorState kKick{.position_m = 0.0, .velocity_mps = 1.0};
constexpr OscillatorState kRelease{.position_m = 1.0, .velocity_mps = 0.0};

TEST(IntegratorClaims, HoldOnOneProblem) {
  // omega 2, zeta 0.3: 1/2 is best at h = 0.1, 3/8 at h = 0.4 by 18 %.
  const Oscillator o = oscillator(2.0, 0.3);
  const auto error = [&o](const Method& m, double h) { return rms(o, kKick, m, h).velocity_mps; };
  EXPECT_LT(error(kHalf, 0.1), error(kThreeEighths, 0.1));
  EXPECT_LT(error(kHalf, 0.1), error(kFiveEighths, 0.1));
  EXPECT_NEAR(error(kThreeEighths, 0.4) / error(kHalf, 0.4), 0.82, 0.01);
}

TEST(IntegratorClaims, OnThatProblemMidpointAveragingIsTheBestOfThreeAtEveryStep) {
  // Of a motion that begins with 1 m/s: RMS of the velocity at 0.02, 0.1 and 0.4 s.
  const Oscillator o = oscillator(2.0, 0.3);
  const auto error_mps = [&o](const Method& m, double h) {
    return rms(o, kKick, m, h).velocity_mps;
  };
  for (const double h : {0.02, 0.1, 0.4}) {
    EXPECT_LT(error_mps(kHalf, h), 0.6 * error_mps(kImproved, h)) << h;
    EXPECT_LT(error_mps(kImproved, h), 0.4 * error_mps(kExplicit, h)) << h;
  }
  EXPECT_NEAR(error_mps(kHalf, 0.02), 5.11e-5, 1e-7);
  EXPECT_NEAR(error_mps(kHalf, 0.1), 1.42e-3, 1e-5);
  EXPECT_NEAR(error_mps(kHalf, 0.4), 32.8e-3, 1e-4);
}

// "A fitting alpha costs nothing": a step does not, but finding it asks for the answer first.
TEST(IntegratorClaims, FindingAlphaCostsTwoThousandRuns) {
  const auto forces = [](Integrator integrator, double h) {
    const auto& entry =
        *std::ranges::find(kIntegratorNames, integrator, &IntegratorName::integrator);
    return std::lround(10.0 / h) * entry.force_evaluations;
  };
  EXPECT_EQ(forces(Integrator::kRk4, 1e-4) / forces(Integrator::kMidpointAveraging, 0.1), 2000);
}

// X18  "3/8 is best at large steps": without damping it makes energy, and no step is small enough.
TEST(IntegratorClaims, ThreeEighthsPumpsEnergyWithoutDamping) {
  const Oscillator o = oscillator(2.0, 0.0);
  for (const double h : {0.4, 0.1, 0.02}) {
    const double z = 2.0 * h;
    EXPECT_NEAR(determinant(amplification(kThreeEighths, z, 0.0)), 1.0 + z * z / 8.0, 1e-14);
    OscillatorState at = kKick;
    for (int i = 0; i < static_cast<int>(300.0 / h); ++i) at = step(o, at, kThreeEighths, h);
    const double energy_J =
        0.5 * (at.velocity_mps * at.velocity_mps + 4.0 * at.position_m * at.position_m);
    EXPECT_GT(energy_J, 2.0 * 0.5) << "after 300 s with h = " << h;
  }
  EXPECT_NEAR(
      rms(o, kKick, kThreeEighths, 0.4).velocity_mps / rms(o, kKick, kHalf, 0.4).velocity_mps, 2.44,
      0.01);
}

TEST(IntegratorClaims, OneHalfConservesItsOwnInvariantForEver) {
  // z^2 x^2 + (1 - z^2 / 4) (h v)^2
  const double h = 0.4, z = 0.8;
  const auto invariant = [h, z](const OscillatorState& s) {
    return z * z * s.position_m * s.position_m +
           (1.0 - z * z / 4.0) * h * h * s.velocity_mps * s.velocity_mps;
  };
  OscillatorState at{0.3, 1.0};
  const double first = invariant(at);
  for (int i = 0; i < 100000; ++i) at = step(oscillator(2.0, 0.0), at, kHalf, h);
  EXPECT_NEAR(invariant(at) / first, 1.0, 1e-9);
}

// X19  "does not use explicit Euler, so the step has little influence"
TEST(IntegratorClaims, ThePredictorIsExplicitEulerAndLimitsTheStep) {
  double least = 10.0;
  for (double zeta = 0.0; zeta < 0.5; zeta += 0.01)
    least = std::min(least, largest_stable_z(kHalf, zeta));
  EXPECT_NEAR(least, 1.732, 1e-3);
  for (const double zeta : {0.5, 0.8, 1.0, 2.0, 5.0})
    EXPECT_NEAR(largest_stable_z(kHalf, zeta), 1.0 / zeta, 1e-12);
  for (const double zeta : {0.71, 0.8, 1.0, 2.0, 5.0})
    EXPECT_LT(largest_stable_z(kHalf, zeta), largest_stable_z(kExplicit, zeta)) << zeta;
  EXPECT_GT(largest_stable_z(kHalf, 0.70), largest_stable_z(kExplicit, 0.70));
}

TEST(IntegratorClaims, StiffDampingBlowsUpEveryExplicitMethod) {
  const Oscillator o = oscillator(3.0, 2.0);
  for (const auto& entry : kIntegratorNames) {
    const Method method{.integrator = entry.integrator};
    const double error = rms(o, kRelease, method, 0.4).velocity_mps;
    if (entry.integrator == Integrator::kImplicitEuler)
      EXPECT_LT(error, 0.05);
    else
      EXPECT_GT(error, 1e3) << entry.name;
  }
}

// X20  orderings that hold only in parts of the (omega, zeta) plane
TEST(IntegratorClaims, ImprovedEulerLosesToExplicitEulerInDisplacement) {
  const auto improved_wins = [](double zeta) {
    const Oscillator o = oscillator(2.0, zeta);
    return rms(o, kRelease, kImproved, 0.02).position_m <
           rms(o, kRelease, kExplicit, 0.02).position_m;
  };
  EXPECT_TRUE(improved_wins(0.3));
  EXPECT_FALSE(improved_wins(1.0));
  EXPECT_FALSE(improved_wins(2.0));
  // and its stable step is the smaller one from zeta 0.577 on, and always below that of alpha 1/2
  EXPECT_LT(largest_stable_z(kImproved, 0.58), largest_stable_z(kExplicit, 0.58));
  EXPECT_GT(largest_stable_z(kImproved, 0.57), largest_stable_z(kExplicit, 0.57));
  for (double zeta = 0.01; zeta < 3.0; zeta += 0.01)
    EXPECT_LT(largest_stable_z(kImproved, zeta), largest_stable_z(kHalf, zeta));
}

TEST(IntegratorClaims, MidpointAveragingIsNotMoreAccurateAtLargeSteps) {
  const Oscillator o = oscillator(2.0, 0.0);
  EXPECT_NEAR(rms(o, kKick, kImproved, 0.4).velocity_mps, 0.165, 1e-3);
  EXPECT_NEAR(rms(o, kKick, kHalf, 0.4).velocity_mps, 0.245, 1e-3);
}

TEST(IntegratorClaims, ThreeEighthsIsNotBestAtLargeStepsOfSlowOrLightlyDampedMotion) {
  for (const double omega : {0.3, 0.7, 1.0, 2.0}) {
    for (const double zeta : {0.0, 0.1, 0.3}) {
      const Oscillator o = oscillator(omega, zeta);
      EXPECT_LT(rms(o, kRelease, kHalf, 0.4).velocity_mps,
                rms(o, kRelease, kThreeEighths, 0.4).velocity_mps)
          << omega << " rad/s, " << zeta;
    }
  }
  // and where the motion is fast and damped, 3/8 is best at the small step too
  const Oscillator fast = oscillator(3.0, 2.0);
  EXPECT_LT(rms(fast, kRelease, kThreeEighths, 0.1).velocity_mps,
            rms(fast, kRelease, kHalf, 0.1).velocity_mps);
}

TEST(IntegratorClaims, MidpointAveragingIsImprovedEulerAtTwiceTheCostWithoutDamping) {
  for (const double z : {0.1, 0.7, 1.9}) {
    const Amplification a = amplification(kHalf, z, 0.0), b = amplification(kImproved, z, 0.0);
    EXPECT_NEAR(trace(a), trace(b), 1e-14) << "the same frequency";
    EXPECT_NEAR(determinant(a), determinant(b), 1e-14) << "the same growth: none";
  }
  EXPECT_EQ(kIntegratorNames[2].force_evaluations, 2 * kIntegratorNames[1].force_evaluations);
}

TEST(IntegratorClaims, ImplicitEulerIsNotAlwaysMoreAccurateThanExplicitEuler) {
  // y' = y - 2 x / y, y(0) = 1, exact sqrt(1 + 2 x), on [0, 1] with h = 0.05.
  const double h = 0.05;
  double explicit_y = 1.0, implicit_y = 1.0, explicit_error = 0.0, implicit_error = 0.0;
  for (int i = 0; i < 20; ++i) {
    const double x = h * i, truth = std::sqrt(1.0 + 2.0 * (x + h));
    explicit_y += h * (explicit_y - 2.0 * x / explicit_y);
    // y+ = y + h (y+ - 2 x+ / y+):  (1 - h) y+^2 - y y+ + 2 h x+ = 0
    const double root = implicit_y * implicit_y - 8.0 * h * (1.0 - h) * (x + h);
    implicit_y = (implicit_y + std::sqrt(root)) / (2.0 * (1.0 - h));
    explicit_error = std::max(explicit_error, std::abs(explicit_y - truth));
    implicit_error = std::max(implicit_error, std::abs(implicit_y - truth));
  }
  EXPECT_NEAR(explicit_error, 0.0280, 1e-4);
  EXPECT_NEAR(implicit_error, 0.0322, 1e-4);
  // while on the oscillator it is so
  const Oscillator o = oscillator(2.0, 0.3);
  EXPECT_LT(rms(o, kKick, kImplicit, 0.1).velocity_mps, rms(o, kKick, kExplicit, 0.1).velocity_mps);
}

TEST(IntegratorClaims, TheBestAlphaIsAFitToOneProblem) {
  // Best of a fine list for the velocity: it moves with the start and the step.
  const auto best_alpha = [](const Oscillator& o, const OscillatorState& start, double h) {
    double best = 0.0, least = 1e300;
    for (double alpha = 0.2; alpha <= 0.8; alpha += 0.005) {
      const double e = rms(o, start, {Integrator::kMidpointAveraging, alpha}, h).velocity_mps;
      if (e < least) least = e, best = alpha;
    }
    return best;
  };
  const Oscillator o = oscillator(2.0, 0.5);
  EXPECT_GT(std::abs(best_alpha(o, kKick, 0.4) - best_alpha(o, kKick, 0.1)), 0.03);
  EXPECT_GT(std::abs(best_alpha(o, kKick, 0.4) - best_alpha(o, kRelease, 0.4)), 0.009);
}

}  // namespace tact::model::springs::integrator_claims_test
