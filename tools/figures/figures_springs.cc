// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "model/springs/integrators.h"
#include "tools/figures/figures.h"

namespace tact::tools::figures {
namespace {

using model::springs::exact;
using model::springs::Integrator;
using model::springs::Method;
using model::springs::Oscillator;
using model::springs::OscillatorState;

constexpr double kEnd_s = 10.0;
/// Its oscillator is lost; this one is that of MA-19, on which all its claims hold together.
constexpr Oscillator kMass{.mass_kg = 1.0, .damping_Ns_per_m = 1.2, .stiffness_N_per_m = 4.0};
constexpr OscillatorState kKick{.position_m = 0.0, .velocity_mps = 1.0};
constexpr Method kExplicit{Integrator::kExplicitEuler}, kImproved{Integrator::kImprovedEuler};

Method midpoint(double alpha) { return {Integrator::kMidpointAveraging, alpha}; }
double spring_and_damper_N(const OscillatorState& at) {
  return -kMass.stiffness_N_per_m * at.position_m - kMass.damping_Ns_per_m * at.velocity_mps;
}

/// RMS error of the velocity over 10 s.
double velocity_rms_mps(const Method& method, double step_s) {
  const long steps = std::lround(kEnd_s / step_s);
  OscillatorState at = kKick;
  double sum = 0.0;
  for (long i = 1; i <= steps; ++i) {
    at = model::springs::step(kMass, at, method, step_s);
    const double truth = exact(kMass, kKick, step_s * static_cast<double>(i)).velocity_mps;
    sum += std::pow(at.velocity_mps - truth, 2);
  }
  return std::sqrt(sum / static_cast<double>(steps));
}

/// A method, and the column of what it gives.
struct Curve {
  const char* column;
  Method method;
};

/// For each step the first 6 s: the truth, and what each method makes of it; of(state) is drawn.
template <typename Of>
Rows runs(std::initializer_list<double> steps_s, const char* truth,
          const std::vector<Curve>& curves, Of of) {
  Rows rows;
  for (const double step_s : steps_s) {
    std::vector<OscillatorState> at(curves.size(), kKick);
    const long steps = std::lround(6.0 / step_s);
    for (long i = 0; i <= steps; ++i) {
      const double time_s = step_s * static_cast<double>(i);
      report::Row row{
          {"step_s", step_s}, {"time_s", time_s}, {truth, of(exact(kMass, kKick, time_s))}};
      for (std::size_t k = 0; k < curves.size(); ++k) {
        row.emplace_back(curves[k].column, of(at[k]));
        at[k] = model::springs::step(kMass, at[k], curves[k].method, step_s);
      }
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

const std::vector<Curve> kThreeMethods{
    {"explicit_m", kExplicit}, {"improved_m", kImproved}, {"midpoint_m", midpoint(0.5)}};

double position_m(const OscillatorState& at) { return at.position_m; }

}  // namespace

Rows euler_methods() {
  // The scalar equation of the figure is lost: y' = y - 2 x/y is ours, its step is as printed.
  constexpr double kStep = 0.05;
  const auto slope = [](double x, double y) { return y - 2.0 * x / y; };
  double forward = 1.0, backward = 1.0, rk4 = 1.0;
  Rows rows{{{"x", 0.0}, {"explicit", 0.0}, {"implicit", 0.0}, {"rk4", 0.0}}};
  for (int i = 0; i < 20; ++i) {
    const double x = kStep * i, next = kStep * (i + 1), truth = std::sqrt(1.0 + 2.0 * next);
    const double k1 = slope(x, rk4), k2 = slope(x + kStep / 2, rk4 + kStep / 2 * k1);
    const double k3 = slope(x + kStep / 2, rk4 + kStep / 2 * k2),
                 k4 = slope(next, rk4 + kStep * k3);
    rk4 += kStep / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    forward += kStep * slope(x, forward);
    // with h the step: (1 - h) y+^2 - y y+ + 2 h x+ = 0
    backward = (backward + std::sqrt(backward * backward - 8.0 * kStep * (1.0 - kStep) * next)) /
               (2.0 * (1.0 - kStep));
    rows.push_back({{"x", next},
                    {"explicit", forward - truth},
                    {"implicit", backward - truth},
                    {"rk4", rk4 - truth}});
  }
  return rows;
}

Rows alpha_search() {
  Rows rows;
  for (int i = 0; i <= 80; ++i) {
    const double alpha = 0.3 + 0.005 * i;
    rows.push_back({{"alpha", alpha},
                    {"rms_h01_mps", velocity_rms_mps(midpoint(alpha), 0.1)},
                    {"rms_h04_mps", velocity_rms_mps(midpoint(alpha), 0.4)}});
  }
  return rows;
}

std::vector<Printed> best_alpha() {
  const auto best_of_three = [](double step_s) {
    return std::ranges::min(std::array{0.375, 0.5, 0.625}, {}, [step_s](double alpha) {
      return velocity_rms_mps(midpoint(alpha), step_s);
    });
  };
  return {{"best of three alpha at 0.1 s", 0.5, best_of_three(0.1)},
          {"best of three alpha at 0.4 s", 0.375, best_of_three(0.4)}};
}

Rows alpha_curves() {
  return runs({0.1, 0.4}, "truth_mps",
              {{"alpha_4_8_mps", midpoint(0.5)},
               {"alpha_3_8_mps", midpoint(0.375)},
               {"alpha_5_8_mps", midpoint(0.625)}},
              [](const OscillatorState& at) { return at.velocity_mps; });
}

Rows step_methods() {
  Rows rows = runs({0.1}, "truth_m", kThreeMethods, position_m);
  const Rows force =
      runs({0.1}, "truth_N",
           {{"explicit_N", kExplicit}, {"improved_N", kImproved}, {"midpoint_N", midpoint(0.5)}},
           spring_and_damper_N);
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i].insert(rows[i].end(), force[i].begin() + 2, force[i].end());
  return rows;
}

Rows step_sizes() { return runs({0.02, 0.1, 0.4}, "truth_m", kThreeMethods, position_m); }

}  // namespace tact::tools::figures
