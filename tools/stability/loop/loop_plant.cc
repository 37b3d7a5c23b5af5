// SPDX-License-Identifier: Apache-2.0
#include "tools/stability/loop/loop_plant.h"

#include <algorithm>
#include <cmath>

namespace tact::tools::stability {
namespace {

// The resolution of a double for two times of one step.
constexpr int kBisections = 50;
// Rounding must not make stops and starts go on for ever.
constexpr int kMaxEvents = 10'000;

}  // namespace

LoopPlant::LoopPlant(const PlantParameters& parameters) : p_(parameters) {
  // (B/M h)^n / n! and (k/M h^2)^(n/2) / n! are below rounding at n = kTerms
  const double fastest =
      std::max(p_.damping_Ns_per_m / p_.mass_kg, std::sqrt(p_.stiffness_N_per_m / p_.mass_kg));
  longest_step_s_ = fastest > 0.0 ? 0.25 / fastest : 1.0;
}

void LoopPlant::expand(double force_N) {
  y_[0] = position_m_;
  y_[1] = velocity_mps_;
  // M (n+2)(n+1) y_(n+2) = f [n = 0] - B (n+1) y_(n+1) - k y_n
  for (std::size_t n = 0; n + 2 < kTerms; ++n) {
    const auto i = static_cast<double>(n);
    const double f = n == 0 ? force_N : 0.0;
    y_[n + 2] = (f - p_.damping_Ns_per_m * (i + 1.0) * y_[n + 1] - p_.stiffness_N_per_m * y_[n]) /
                (p_.mass_kg * (i + 2.0) * (i + 1.0));
  }
}

double LoopPlant::position_at(double t_s) const {
  double y = 0.0;
  for (std::size_t n = kTerms; n-- > 0;) y = y * t_s + y_[n];
  return y;
}

double LoopPlant::velocity_at(double t_s) const {
  double v = 0.0;
  for (std::size_t n = kTerms; n-- > 1;) v = v * t_s + static_cast<double>(n) * y_[n];
  return v;
}

/// The velocity has turned against `direction` within the step: when was it zero?
double LoopPlant::stop_time_s(double direction, double step_s) const {
  double low_s = 0.0, high_s = step_s;
  for (int i = 0; i < kBisections; ++i) {
    const double middle_s = 0.5 * (low_s + high_s);
    (velocity_at(middle_s) * direction > 0.0 ? low_s : high_s) = middle_s;
  }
  return high_s;
}

void LoopPlant::move(double force_N, double duration_s) {
  double left_s = duration_s;
  stuck_ = false;
  for (int i = 0; left_s > 0.0 && i < kMaxEvents; ++i) {
    double direction = velocity_mps_ > 0.0 ? 1.0 : -1.0;
    // Coulomb: at rest friction balances any pull, up to c; in motion it is c against the way.
    if (velocity_mps_ == 0.0) {
      const double net_N = force_N - p_.stiffness_N_per_m * position_m_;
      stuck_ = std::abs(net_N) <= p_.friction_N;
      if (stuck_) {  // until the force changes
        // Not if it came to rest within this move: then it has moved.
        stuck_ = i == 0;
        return;
      }
      direction = net_N > 0.0 ? 1.0 : -1.0;
    }
    const double step_s = std::min(left_s, longest_step_s_);
    expand(force_N - direction * p_.friction_N);
    const double end_mps = velocity_at(step_s);
    // Without friction a turn is no event: the series goes on through it.
    const bool stops = p_.friction_N > 0.0 && end_mps * direction < 0.0;
    const double moved_s = stops ? stop_time_s(direction, step_s) : step_s;
    position_m_ = position_at(moved_s);
    velocity_mps_ = stops ? 0.0 : end_mps;
    left_s -= moved_s;
  }
}

}  // namespace tact::tools::stability
