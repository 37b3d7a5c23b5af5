// SPDX-License-Identifier: Apache-2.0
#include "firmware/admission/torque_note.h"

#include <fmt/format.h>

#include <algorithm>

namespace tact::firmware::admission {

std::string torque_note(const model::scene::Scene& scene, const hal::DeviceInfo& device) {
  double lever_m = 0.0;
  for (const model::contact::ProbeSphere& sphere : scene.tool.spheres)
    lever_m = std::max(lever_m, norm(sphere.offset_m));
  if (!(lever_m > 0.0) || !(scene.limits.torque_Nm > 0.0)) return {};
  if (device.max_torque_Nm > 0.0) return {};
  return fmt::format(
      "{}: this device has no torque: of the tool's wrench the force is felt at the handle, and "
      "the "
      "torque of its {:.0f} mm lever is lost",
      scene.path, 1e3 * lever_m);
}

}  // namespace tact::firmware::admission
