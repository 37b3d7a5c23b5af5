// SPDX-License-Identifier: Apache-2.0
// Does the simulated hand reach the organ, and does the organ's size fit the workspace?
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "firmware/admission/notes.h"
#include "model/contact/contact_point.h"
#include "model/mesh/mesh.h"

namespace tact::firmware::admission {
namespace {

using model::Vec3;
using model::mesh::SurfaceMesh;

// Relative to the workspace's width. Organs of the shipped scenes have 0.2 to 0.4 of it. Reading
// millimetres as metres makes an organ 1000 times too large, centimetres 100 times.
constexpr double kMinOrgan_ratio = 0.02, kMaxOrgan_ratio = 20.0;
constexpr int kPlacesOfAStroke = 8;

/// Signed distance to the surface, from the triangle of the nearest vertex.
double distance_m(const SurfaceMesh& organ, const Vec3& p) {
  std::size_t nearest = 0;
  double least_m2 = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < organ.vertex_m.size(); ++v) {
    const Vec3 d = organ.vertex_m[v] - p;
    const double d_m2 = dot(d, d);
    if (d_m2 < least_m2) {
      least_m2 = d_m2;
      nearest = v;
    }
  }
  return follow(organ.view(), organ.fan[organ.fan_start[nearest]], p).distance_m;
}

/// Least distance of the spheres from the surface along the hand's path; negative: they reach it.
double least_gap_m(const model::scene::Scene& scene) {
  double least_m = std::numeric_limits<double>::infinity();
  const auto& path = scene.hand.path;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    for (int k = 1; k <= kPlacesOfAStroke; ++k) {
      const double share = static_cast<double>(k) / kPlacesOfAStroke;
      const Vec3 tool = path[i].position_m + share * (path[i + 1].position_m - path[i].position_m);
      for (const model::contact::ProbeSphere& sphere : scene.tool.spheres)
        least_m = std::min(least_m,
                           distance_m(scene.organ_mesh, tool + sphere.offset_m) - sphere.radius_m);
    }
  }
  return least_m;
}

}  // namespace

std::string reach_note(const model::scene::Scene& scene) {
  const auto sum = model::mesh::summarize(scene.organ_mesh);
  const Vec3 extent_m = sum.high_m - sum.low_m;
  const double size_m = std::max({extent_m.x, extent_m.y, extent_m.z});
  const double ratio = size_m / (2.0 * scene.limits.workspace_radius_m);
  const char* const remedy = "tact-mesh MESH --align SCENE finds what to write";
  if (ratio < kMinOrgan_ratio || ratio > kMaxOrgan_ratio)
    return fmt::format(
        "{}: the organ is {:.3g} m long in a workspace {:.3g} m wide: is organ.mesh_unit_m the "
        "unit of its file? {}",
        scene.path, size_m, 2.0 * scene.limits.workspace_radius_m, remedy);
  if (scene.hand.path.size() < 2) return {};
  const double gap_m = least_gap_m(scene);
  if (gap_m <= 1e-4) return {};  // a stroke of depth 0 ends at the surface
  return fmt::format(
      "{}: no stroke of the hand reaches the organ, {:.3g} mm are missing: change "
      "organ.position_m, "
      "organ.orientation_deg or hand.site_m; {}",
      scene.path, 1e3 * gap_m, remedy);
}

}  // namespace tact::firmware::admission
