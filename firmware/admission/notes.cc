// SPDX-License-Identifier: Apache-2.0
#include "firmware/admission/notes.h"

#include <fmt/format.h>

#include <algorithm>

#include "hal/lines_settings.h"
#include "model/mesh/mesh.h"

namespace tact::firmware::admission {

bool cannot_grip(const model::scene::Scene& scene, const hal::DeviceInfo& device) {
  const bool grips =
      std::ranges::any_of(scene.hand.path,
                          [](const auto& way_point) { return way_point.grip_ratio > 0.0; }) ||
      std::ranges::any_of(scene.tasks, &model::scene::Task::by_grip);
  const auto& lines = scene.device.of<hal::LinesSettings>();
  const bool has_switch = lines.wired() && lines.grip >= 0;
  return grips && device.grip.kind == hal::GripKind::kNone && !has_switch;
}

std::string grip_note(const model::scene::Scene& scene, const hal::DeviceInfo& device) {
  if (!cannot_grip(scene, device)) return {};
  return fmt::format(
      "{}: this scene grips; this device cannot: connect device.lines.grip, or nothing is held, "
      "pulled or torn",
      scene.path);
}

std::string open_organ_note(const model::scene::Scene& scene) {
  const std::size_t edges = model::mesh::summarize(scene.organ_mesh).boundary_edges;
  if (edges == 0) return {};
  return fmt::format(
      "{}: the organ is open, with {} boundary edges; beside the boundary of an open surface there "
      "is no inside: a tool that comes in through a hole gives no force until it has once been "
      "outside; tact-mesh MESH --close-holes closes it",
      scene.path, edges);
}

std::string parts_note(const model::scene::Scene& scene) {
  const std::size_t parts = model::mesh::count_parts(scene.organ_mesh);
  std::string text;
  if (parts > 1 && scene.look.piece_color_ratio.empty())
    text = fmt::format(
        "the organ has {} parts that share no edge, and all are felt; is only one the organ? "
        "tact-mesh {} --largest keeps that with most faces",
        parts, scene.organ.mesh_path);
  if (scene.organ.is_turned)
    text += fmt::format("{}the normals of {} point inwards and were turned",
                        text.empty() ? "" : "; ", scene.organ.mesh_path);
  return text.empty() ? text : fmt::format("{}: {}", scene.path, text);
}

std::string torque_note(const model::scene::Scene& scene, const hal::DeviceInfo& device) {
  double lever_m = 0.0;
  for (const model::contact::ProbeSphere& sphere : scene.tool.spheres)
    lever_m = std::max(lever_m, norm(sphere.offset_m));
  if (!(lever_m > 0.0) || !(scene.limits.torque_Nm > 0.0)) return {};
  if (device.max_torque_Nm > 0.0) return {};
  return fmt::format(
      "{}: this device has no torque: of the tool's wrench the force is felt at the handle, and "
      "the torque of its {:.0f} mm lever is lost",
      scene.path, 1e3 * lever_m);
}

}  // namespace tact::firmware::admission
