// SPDX-License-Identifier: Apache-2.0
#include "tools/sweep/reference_presses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "model/io/json.h"
#include "model/scene/tissue.h"
#include "tools/ground_truth/reference_fits.h"

namespace tact::tools::sweep {
namespace {

using ground_truth::tool_at;
using ground_truth::ToolCase;
using ground_truth::ToolPoint;
using model::Result;
using model::Tool;
using model::Vec3;
using nlohmann::json;

constexpr double kStep_m = 2e-5, kAbove_m = 5e-4;
constexpr double kFirst_m = 0.99e-3;  // of the depths that are evaluated

/// A press of the scene, step by step, held against one of the reference.
ReferencePress check(const model::scene::Scene& scene,
                     const model::contact::ContactScene& contact_scene, const ToolPoint& place) {
  ReferencePress out;
  out.place = name_of(place);
  model::contact::Contact contact(contact_scene);
  double depth_m = -kAbove_m;
  Vec3 force_N;
  const auto render_force = [&](double at_m) {
    const Tool tool = tool_at(scene, place, at_m);
    contact.detect_contact(tool);
    force_N = contact.render_force(tool, false).wrench.force_N;
  };
  for (const ToolCase& truth : place.cases) {
    for (; depth_m < truth.depth_m - 0.5 * kStep_m; depth_m += kStep_m) render_force(depth_m);
    render_force(truth.depth_m);
    if (truth.depth_m < kFirst_m) continue;
    const double off = -dot(force_N, place.direction) / truth.force_N - 1.0;
    out.off_ratio.push_back({truth.depth_m, off});
    if (std::abs(off) > std::abs(out.worst_ratio))
      out.worst_ratio = off, out.worst_depth_m = truth.depth_m;
    for (std::size_t i = 0; i < truth.sphere_N.size(); ++i) {
      const double jaw_N = -dot(contact.contacts()[i].force_N, place.direction);
      out.worst_jaw_ratio =
          std::max(out.worst_jaw_ratio, std::abs(jaw_N - truth.sphere_N[i]) / truth.force_N);
    }
  }
  return out;
}

}  // namespace

Result<std::vector<ReferencePress>> press_reference(const model::scene::Scene& scene,
                                                    const std::string& path) {
  const auto reference = ground_truth::read_tool_reference(path);
  if (!reference) return reference.error();
  if (auto differs = check_tool_reference_fits(*reference, scene)) return std::move(*differs);
  model::scene::Scene smooth = scene;
  smooth.contact.friction_ratio = 0.0;
  smooth.relaxation.clear();
  const auto tissue = make_tissue(smooth);
  if (!tissue) return tissue.error();
  std::vector<ReferencePress> out;
  for (const ToolPoint& place : reference->places)
    out.push_back(check(smooth, (*tissue)->contact_scene(), place));
  return out;
}

std::string text_of(const std::vector<ReferencePress>& presses) {
  std::string out = "force along the way, from 1 mm on, without friction\n";
  for (const ReferencePress& p : presses)
    out += fmt::format(
        "{:<14} {:+.1f} % at {:.1f} mm, one sphere {:.1f} % of the whole tool's force\n", p.place,
        100.0 * p.worst_ratio, 1e3 * p.worst_depth_m, 100.0 * p.worst_jaw_ratio);
  return out;
}

std::string json_of(const std::vector<ReferencePress>& presses) {
  json out = json::object();
  for (const ReferencePress& p : presses)
    out[p.place] = {{"off_ratio", p.off_ratio},
                    {"worst_ratio", p.worst_ratio},
                    {"worst_depth_m", p.worst_depth_m},
                    {"worst_sphere_ratio", p.worst_jaw_ratio}};
  return model::io::text_of(out, 2);
}

}  // namespace tact::tools::sweep
