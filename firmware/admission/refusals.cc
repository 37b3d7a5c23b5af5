// SPDX-License-Identifier: Apache-2.0
#include "firmware/admission/refusals.h"

#include <fmt/format.h>

#include <cmath>

#include "hal/can/can_settings.h"
#include "model/scene/scene_limits.h"

namespace tact::firmware::admission {

std::optional<model::Error> check_thermal(const model::scene::Scene& scene,
                                          const model::Limits& limits) {
  const double least_s = model::scene::least_thermal_time_s(limits, scene.rate_Hz);
  if (limits.thermal_time_s >= least_s) return std::nullopt;
  return model::Error{fmt::format(
      "{}: limits.thermal_time_s = {} is too short for this device, which bears {:.3g} N for long "
      "and {:.3g} N at most; allowed: {:.2f} or more, or a lower limits.force_N",
      scene.path, limits.thermal_time_s, limits.continuous_force_N, limits.force_N,
      std::ceil(100.0 * least_s) / 100.0)};
}

std::optional<model::Error> why_not_unattended(const model::scene::Scene& scene, bool is_service) {
  const bool is_odrive = scene.device.kind == "can-odrive";
  const auto& can = scene.device.of<hal::can::CanSettings>();
  if (!is_service || !hal::can::is_on_can(scene.device) || can.homing != hal::can::Homing::kJig)
    return std::nullopt;
  return model::Error{fmt::format(
      "device.can.homing = \"jig\": a service would believe that the arms rest on the jig whenever "
      "it starts, after a crash too; choose \"absolute\"{}, or start tactd by hand with the arms "
      "on the jig",
      is_odrive ? " or \"index\"" : "")};
}

}  // namespace tact::firmware::admission
