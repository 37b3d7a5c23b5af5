// SPDX-License-Identifier: Apache-2.0
#include "firmware/admission/grip_note.h"

#include <fmt/format.h>

#include <algorithm>

namespace tact::firmware::admission {

bool cannot_grip(const model::scene::Scene& scene, const hal::DeviceInfo& device) {
  const bool grips = std::ranges::any_of(
      scene.hand.path, [](const auto& way_point) { return way_point.grip_ratio > 0.0; });
  const bool has_switch = scene.device.lines.wired() && scene.device.lines.grip >= 0;
  return grips && device.grip.kind == hal::GripKind::kNone && !has_switch;
}

std::string grip_note(const model::scene::Scene& scene, const hal::DeviceInfo& device) {
  if (!cannot_grip(scene, device)) return {};
  return fmt::format(
      "{}: this scene grips; this device cannot: connect device.lines.grip, or nothing is held, "
      "pulled or torn",
      scene.path);
}

}  // namespace tact::firmware::admission
