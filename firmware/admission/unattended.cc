// SPDX-License-Identifier: Apache-2.0
#include "firmware/admission/unattended.h"

#include <fmt/format.h>

namespace tact::firmware::admission {

std::optional<model::Error> why_not_unattended(const model::scene::Scene& scene, bool is_service) {
  const bool is_odrive = scene.device.kind == "can-odrive";
  if (!is_service || !scene.device.is_on_can() || scene.device.can.homing != model::Homing::kJig)
    return std::nullopt;
  return model::Error{fmt::format(
      "device.can.homing = \"jig\": a service would believe that the arms rest on the jig whenever "
      "it starts, after a crash too; choose \"absolute\"{}, or start tactd by hand with the arms "
      "on the jig",
      is_odrive ? " or \"index\"" : "")};
}

}  // namespace tact::firmware::admission
