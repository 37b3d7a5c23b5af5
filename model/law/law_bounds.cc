// SPDX-License-Identifier: Apache-2.0
#include "model/law/law_bounds.h"

#include <algorithm>
#include <cmath>

namespace tact::model::law {
namespace {

// Samples of a range, chosen: three in each of 64 layers of a disc stack, the least smooth law.
constexpr int kSteps = 200;

}  // namespace

double stiffest_N_per_m(const Law& law, double from_m, double to_m) {
  double most_N_per_m = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    // Just inside both ends: at rest a slope may be the mean
    // of press and pull, and beyond a limit it is 0.
    const double ratio = std::clamp(static_cast<double>(i) / kSteps, 1e-6, 1.0 - 1e-6);
    const double k_N_per_m = law.respond(from_m + ratio * (to_m - from_m)).stiffness_N_per_m;
    // Written so that NaN is kept: who bounds the device by it must see it and refuse.
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
  // The tear force is above all that the law can pull: the end of its range.
  if (holds(torn_m)) return torn_m;
  // held_m always holds and torn_m never does; 50 halvings leave 1e-15 of the range between them.
  for (int i = 0; i < 50; ++i) {
    const double middle_m = 0.5 * (torn_m + held_m);
    (holds(middle_m) ? held_m : torn_m) = middle_m;
  }
  return torn_m;
}

}  // namespace tact::model::law
