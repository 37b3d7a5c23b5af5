// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "tools/limits/cases/plan.h"

namespace tact::tools::limits {
namespace {

// 100 Hz, the slowest scene.
constexpr double kLongestPeriod_s = 0.01;

}  // namespace

model::Limits limits_of(const Case& c, const model::Limits& limits) {
  model::Limits tight = limits;
  if (c.budget_share > 0.0) {  // less than twice what the brake needs is refused in a scene
    const double slew_N_per_s = model::slew_beside_ramp_N_per_s(limits);
    // What the gate's tank keeps for its brake (energy_tank.cc), with the longest period.
    const double fall_s = 0.5 * limits.force_N / slew_N_per_s + kLongestPeriod_s;
    const double need_J =
        (limits.speed_mps * limits.force_N + limits.turn_radps * limits.torque_Nm) * fall_s;
    // Tighter only: a case must never loosen what the scene permits.
    tight.energy_J = std::min(limits.energy_J, c.budget_share * 2.0 * need_J);
  }
  if (c.power_share < 1.0)
    tight.power_W = std::min(limits.power_W, c.power_share * limits.force_N * limits.speed_mps);
  if (c.continuous_share < 1.0) {
    // Chosen: the case lasts four of these times, so the mean comes close to its end.
    constexpr double kWarm_s = 0.5;
    tight.continuous_force_N =
        std::min(limits.continuous_force_N, c.continuous_share * limits.force_N);
    tight.thermal_time_s = std::min(limits.thermal_time_s, kWarm_s);
  }
  return tight;
}

}  // namespace tact::tools::limits
