// SPDX-License-Identifier: Apache-2.0
#include "model/io/limits_checksum.h"

#include <fmt/format.h>

#include "model/io/seal.h"

namespace tact::model::io {

std::string limits_text(const Limits& limits) {
  // A limit that is not in the text could change without the digits.
  static_assert(sizeof(Limits) == 14 * sizeof(double), "a limit without a line below");
  std::string out;
  const auto add = [&out](const char* name, double value) {
    out += fmt::format("{} = {}\n", name, value);  // the shortest text that is this number alone
  };
  add("force_N", limits.force_N);
  add("torque_Nm", limits.torque_Nm);
  add("slew_N_per_s", limits.slew_N_per_s);
  add("ramp_s", limits.ramp_s);
  add("workspace_radius_m", limits.workspace_radius_m);
  add("workspace_half_length_m", limits.workspace_half_length_m);
  add("speed_mps", limits.speed_mps);
  add("turn_radps", limits.turn_radps);
  add("energy_J", limits.energy_J);
  add("recovery_W", limits.recovery_W);
  add("continuous_force_N", limits.continuous_force_N);
  add("thermal_time_s", limits.thermal_time_s);
  add("power_W", limits.power_W);
  add("grip_force_N", limits.grip_force_N);
  return out;
}

std::string limits_checksum(const Limits& limits) {
  return sha256_of(limits_text(limits)).substr(0, kChecksumDigits);
}

}  // namespace tact::model::io
