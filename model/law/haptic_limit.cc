// SPDX-License-Identifier: Apache-2.0
#include "model/law/haptic_limit.h"

#include <cmath>
#include <limits>

#include "model/ranges.h"

namespace tact::model::law {
namespace {

bool is_valid(const DeviceAtTool& d) RT_SAFE {
  return is_not_negative(d.damping_Ns_per_m) && is_not_negative(d.friction_N) &&
         is_not_negative(d.position_step_m) && is_not_negative(d.delay_s);
}

}  // namespace

HapticLimit haptic_limit(const DeviceAtTool& device, double rate_Hz,
                         double virtual_damping_Ns_per_m, double lost_share) RT_SAFE {
  // A limit of zero refuses every law: numbers that are broken never let a spring through.
  if (!is_valid(device) || !(std::isfinite(rate_Hz) && rate_Hz > 0.0)) return {};
  if (!std::isfinite(virtual_damping_Ns_per_m)) return {};
  if (!(lost_share >= 0.0 && lost_share < 1.0)) return {};
  // HL-4: a hold lasts n periods where n - 1 samples in a row are lost, each with the share p. What
  // counts is E[n^2] / E[n] of the holds, for the longer one is felt for longer.
  const double hold_s = (1.0 + lost_share) / (1.0 - lost_share) / rate_Hz;
  const double spare_Ns_per_m = device.damping_Ns_per_m - std::abs(virtual_damping_Ns_per_m);
  HapticLimit limit;
  // HL-1  K_grow = (b - |B|) / (T/2 + t_d)
  limit.grow_N_per_m =
      spare_Ns_per_m > 0.0 ? spare_Ns_per_m / (0.5 * hold_s + device.delay_s) : 0.0;
  // HL-2  K_quiet = 2 c / D
  limit.quiet_N_per_m = device.position_step_m > 0.0
                            ? 2.0 * device.friction_N / device.position_step_m
                            : std::numeric_limits<double>::infinity();
  return limit;
}

}  // namespace tact::model::law
