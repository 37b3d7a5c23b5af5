// SPDX-License-Identifier: Apache-2.0
#include "model/law/law_bounds.h"

#include <algorithm>
#include <cmath>

namespace tact::model::law {
namespace {

constexpr int kSteps = 200;

}  // namespace

double stiffest_N_per_m(const Law& law, double from_m, double to_m) {
  double most_N_per_m = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double ratio = std::clamp(static_cast<double>(i) / kSteps, 1e-6, 1.0 - 1e-6);
    const double k_N_per_m = law.respond(from_m + ratio * (to_m - from_m)).stiffness_N_per_m;
    if (!(k_N_per_m <= most_N_per_m)) most_N_per_m = k_N_per_m;
    if (std::isnan(most_N_per_m)) break;
  }
  return most_N_per_m;
}

double most_damping_Ns_per_m(const Law& law) {
  double most_Ns_per_m = 0.0;
  for (int i = 0; i <= kSteps; ++i)
    most_Ns_per_m = std::max(most_Ns_per_m, law.damping_Ns_per_m(law.range().press_m * i / kSteps));
  return most_Ns_per_m;
}

double tear_depth_m(const Law& law, double tear_force_N) {
  const auto holds = [&](double depth_m) { return law.respond(depth_m).force_N >= -tear_force_N; };
  double torn_m = law.range().pull_m, held_m = 0.0;
  if (holds(torn_m)) return torn_m;
  for (int i = 0; i < 50; ++i) {
    const double middle_m = 0.5 * (torn_m + held_m);
    (holds(middle_m) ? held_m : torn_m) = middle_m;
  }
  return torn_m;
}

}  // namespace tact::model::law
