// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/misfit.h"

#include <fmt/format.h>

#include <algorithm>

#include "model/scene/compliance_file.h"
#include "model/scene/tissue_map.h"
#include "tools/mesh/held_box.h"
#include "tools/mesh/place.h"

namespace tact::tools::mesh {
namespace {

using model::scene::Scene;

void check_held_box(const Scene& after, bool is_same, std::vector<Misfit>& misfits) {
  if (!after.elastic) return;
  auto organ = after.organ_mesh;
  shift(organ, -after.organ.position_m);
  const std::size_t held =
      held_triangles(organ, {after.elastic->fixed_min_m, after.elastic->fixed_max_m});
  if (is_same && held > 0 && held < organ.triangle.size()) return;
  const HeldBox box = far_tenth(organ, after.hand_inward);
  misfits.push_back(
      {.keys = "elastic.fixed_min_m, elastic.fixed_max_m",
       .text = fmt::format("hold {} of this organ's {} triangles; to hold the tenth that is "
                           "farthest from the tool, write fixed_min_m = {} and fixed_max_m = {}",
                           held, organ.triangle.size(), toml_of(box.min_m), toml_of(box.max_m))});
}

void check_sites(const Scene& after, bool is_same_file, std::vector<Misfit>& misfits) {
  const auto& sites = after.reference_sites;
  const std::size_t vertices = after.organ_mesh.vertex_m.size();
  const bool all_exist = std::all_of(sites.begin(), sites.end(),
                                     [&](const auto& site) { return site.vertex < vertices; });
  if (sites.empty() || (is_same_file && all_exist)) return;
  misfits.push_back({.keys = "reference_site",
                     .text = fmt::format("{} vertices of another organ; write vertices of this "
                                         "one, 0 to {}, or remove these sections",
                                         sites.size(), vertices - 1)});
}

void check_map(const Scene& after, std::vector<Misfit>& misfits) {
  if (after.compliance.map_path.empty()) return;
  const auto map = read_scene_map(after);
  if (!map) misfits.push_back({.keys = "compliance.map", .text = map.error().message});
}

}  // namespace

std::vector<Misfit> misfits_of(const Scene* before, const Scene& after) {
  const auto shape = [](const Scene& s) { return model::scene::surface_hash(s.organ_mesh.view()); };
  const bool is_same_file = before != nullptr && before->organ.mesh_path == after.organ.mesh_path;
  std::vector<Misfit> misfits;
  check_held_box(after, is_same_file && shape(*before) == shape(after), misfits);
  check_sites(after, is_same_file, misfits);
  check_map(after, misfits);
  return misfits;
}

}  // namespace tact::tools::mesh
