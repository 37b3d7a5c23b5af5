// SPDX-License-Identifier: Apache-2.0
#include "tools/ground_truth/reference_fits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/scene/scene_strokes.h"

namespace tact::tools::ground_truth {
namespace {

using model::Error;
using model::Vec3;
using model::scene::Scene;

constexpr double kSamePoint_m = 1e-6;
constexpr double kSame_ratio = 1e-6;

bool is_same(double a, double b) { return std::abs(a - b) <= kSame_ratio * std::abs(b); }

bool is_same(const Vec3& a, const Vec3& b) { return norm(a - b) < kSamePoint_m; }

constexpr const char* kTool = "--tool ";

/// `how`: the options of the command that solves such a reference.
Error differs(const Scene& scene, const std::string& what, const char* how = "") {
  return {fmt::format("{0}: {1}; solve it again: tact-lab reference {0} {2}--out FILE", scene.path,
                      what, how)};
}

std::optional<Error> elastic_differs(const SolvedBody& body, const Scene& scene, ModulusOf modulus,
                                     const char* how) {
  const auto& elastic = *scene.elastic;
  if (!is_same(body.poisson_ratio, elastic.poisson_ratio))
    return differs(scene,
                   fmt::format("elastic.poisson_ratio is {:g}, the reference's {:g}",
                               elastic.poisson_ratio, body.poisson_ratio),
                   how);
  if (modulus == ModulusOf::kSame && !is_same(body.youngs_modulus_Pa, elastic.youngs_modulus_Pa))
    return differs(scene,
                   fmt::format("elastic.youngs_modulus_Pa is {:g}, the reference's {:g}",
                               elastic.youngs_modulus_Pa, body.youngs_modulus_Pa),
                   how);
  if (!is_same(body.fixed_min_m, elastic.fixed_min_m) ||
      !is_same(body.fixed_max_m, elastic.fixed_max_m))
    return differs(scene, "the reference was solved with another held box [elastic]", how);
  return std::nullopt;
}

}  // namespace

std::optional<Error> check_reference_fits(const ReferenceData& reference, const Scene& scene,
                                          ModulusOf modulus) {
  const double radius_m = scene.tool.spheres[0].radius_m;
  if (!is_same(reference.tool_radius_m, radius_m))
    return differs(scene, fmt::format("the tool's first sphere has radius {:g} mm, the reference "
                                      "was solved with {:g} mm",
                                      radius_m * 1e3, reference.tool_radius_m * 1e3));
  for (const SolvedSite& site : reference.sites) {
    const auto& vertices = scene.organ_mesh.vertex_m;
    const bool is_there = site.vertex < vertices.size() &&
                          is_same(vertices[site.vertex] - scene.organ.position_m, site.point_m);
    if (!is_there)
      return differs(scene, fmt::format("vertex {} is not where the reference of {} has it",
                                        site.vertex, reference.body.mesh));
  }
  return scene.elastic ? elastic_differs(reference.body, scene, modulus, "") : std::nullopt;
}

std::optional<Error> check_tool_reference_fits(const ToolReference& reference, const Scene& scene) {
  const auto& spheres = scene.tool.spheres;
  // Where along the way the tool's own origin lies, as at a longer handle, changes no press.
  Vec3 raised_m;
  if (!spheres.empty() && !reference.sphere.empty())
    raised_m = dot(spheres[0].offset_m - reference.sphere[0].offset_m, scene.hand_inward) *
               scene.hand_inward;
  const auto same = [&raised_m](const auto& a, const auto& b) {
    return is_same(a.offset_m - raised_m, b.offset_m) && is_same(a.radius_m, b.radius_m);
  };
  if (!std::equal(spheres.begin(), spheres.end(), reference.sphere.begin(), reference.sphere.end(),
                  same))
    return differs(scene, "the tool's spheres are not those of the reference", kTool);
  for (const ToolPoint& place : reference.places) {
    const auto& vertices = scene.organ_mesh.vertex_m;
    Vec3 there = scene.hand_site_m + place.slid_m;
    if (place.vertex && *place.vertex < vertices.size()) there = vertices[*place.vertex];
    const Vec3 off = there - scene.organ.position_m - place.point_m;
    if ((place.vertex && *place.vertex >= vertices.size()) ||
        norm(off - dot(off, place.direction) * place.direction) > kSamePoint_m)
      return differs(scene,
                     place.vertex ? fmt::format("vertex {} is not where the reference of {} has it",
                                                *place.vertex, reference.body.mesh)
                                  : "hand.site_m is not where the reference has it",
                     kTool);
  }
  if (scene.elastic) return elastic_differs(reference.body, scene, ModulusOf::kSame, kTool);
  return differs(scene, "has no [elastic], which the reference was solved with", kTool);
}

model::Tool tool_at(const Scene& scene, const ToolPoint& place, double depth_m) {
  // p(d) = point - direction (reach - d), as a press stroke has it (scene_strokes.h)
  const double reach_m = model::scene::reach_m(scene.tool.spheres, scene.hand_inward);
  return {
      .position_m = place.point_m + scene.organ.position_m - (reach_m - depth_m) * place.direction,
      .orientation = place.orientation};
}

}  // namespace tact::tools::ground_truth
