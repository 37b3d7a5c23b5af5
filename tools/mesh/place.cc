// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "model/io/json.h"
#include "model/mesh/turn.h"
#include "model/scene/compliance_file.h"
#include "model/scene/scene.h"
#include "model/scene/tissue_map.h"
#include "tools/mesh/held_box.h"
#include "tools/mesh/unit.h"

namespace tact::tools::mesh {
namespace {

using model::Error;
using model::Result;
using model::Vec3;
using model::scene::Scene;

/// Of the organ's size. Chosen: who reads a point off a picture is off by less.
constexpr double kFar_ratio = 0.1;

/// The longest side of the triangles around a vertex: a point of the surface is nearer than this.
double longest_side_m(const model::mesh::SurfaceMesh& mesh, std::size_t vertex) {
  double longest_m = 0.0;
  for (std::uint32_t i = mesh.fan_start[vertex]; i < mesh.fan_start[vertex + 1]; ++i)
    for (const std::uint32_t v : mesh.triangle[mesh.fan[i]])
      longest_m = std::max(longest_m, norm(mesh.vertex_m[v] - mesh.vertex_m[vertex]));
  return longest_m;
}

std::optional<Error> check_near(const model::mesh::SurfaceMesh& mesh, const PlaceOrder& order,
                                std::size_t nearest) {
  const auto sum = summarize(mesh);
  const double away_m = norm(mesh.vertex_m[nearest] - *order.point * order.unit_m);
  if (away_m <= longest_side_m(mesh, nearest) + kFar_ratio * norm(sum.high_m - sum.low_m))
    return std::nullopt;
  const Vec3 low = sum.low_m / order.unit_m, high = sum.high_m / order.unit_m;
  return Error{fmt::format(
      "--point is {:.4g} mm from the organ, which lies in X {:.6g} to {:.6g}, Y {:.6g} to {:.6g}, "
      "Z {:.6g} to {:.6g} of its file ({}); name a point of its surface, in the file's own frame "
      "and unit",
      1e3 * away_m, low.x, high.x, low.y, high.y, low.z, high.z, name_of(order.unit_m))};
}

/// Fills all but path and unit.
std::optional<Error> place_under_hand(const model::mesh::SurfaceMesh& mesh, const PlaceOrder& order,
                                      const model::scene::Scene& scene, Placement& placement) {
  // The chosen vertex has the least of this: distance from the point, or depth below the top.
  const auto worth = [&](const Vec3& p) {
    return order.point ? norm(p - *order.point * order.unit_m) : dot(p, scene.hand_inward);
  };
  std::size_t chosen = 0;
  for (std::size_t v = 0; v < mesh.vertex_m.size(); ++v)
    if (worth(mesh.vertex_m[v]) < worth(mesh.vertex_m[chosen])) chosen = v;
  if (order.point)
    if (auto error = check_near(mesh, order, chosen)) return error;
  const model::Quat turn =
      order.point ? model::mesh::turn_between(mesh.vertex_normal[chosen], -scene.hand_inward)
                  : model::Quat{};
  placement.orientation_deg = model::mesh::rotation_deg_of(turn);
  placement.site_m = scene.hand_site_m;
  placement.position_m = scene.hand_site_m - rotate(turn, mesh.vertex_m[chosen]);
  return std::nullopt;
}

/// TOML is; a name in Linux may be any bytes.
bool is_utf8(const std::string& text) {
  const auto shown = model::io::text_of(nlohmann::json(text));
  const std::string_view replaced = "\uFFFD";
  return shown.find(replaced) == shown.npos || text.find(replaced) != text.npos;
}

std::vector<std::string> overrides_of(const std::string& section,
                                      const std::vector<KeyValue>& keys) {
  std::vector<std::string> overrides;
  overrides.reserve(keys.size());
  for (const auto& [key, value] : keys)
    overrides.push_back(fmt::format("{}.{}={}", section, key, value));
  return overrides;
}

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

/// `before`: the scene as it was; null if it does not load. `after`: with the organ in its place.
std::vector<Misfit> misfits_of(const Scene* before, const Scene& after) {
  const auto shape = [](const Scene& s) { return model::scene::surface_hash(s.organ_mesh.view()); };
  const bool is_same_file = before != nullptr && before->organ.mesh_path == after.organ.mesh_path;
  std::vector<Misfit> misfits;
  check_held_box(after, is_same_file && shape(*before) == shape(after), misfits);
  check_sites(after, is_same_file, misfits);
  check_map(after, misfits);
  return misfits;
}

}  // namespace

double rounded_m(double x_m) { return std::round(x_m * 1e7) / 1e7 + 0.0; }

std::string toml_of(const Vec3& v) {
  return fmt::format("[{}, {}, {}]", rounded_m(v.x), rounded_m(v.y), rounded_m(v.z));
}

std::vector<KeyValue> organ_keys(const Placement& p) {
  return {{"mesh", model::io::text_of(nlohmann::json(p.mesh_path))},  // quoted alike in TOML
          {"mesh_unit_m", fmt::format("{}", p.unit_m)},
          {"orientation_deg", toml_of(p.orientation_deg)},
          {"position_m", toml_of(p.position_m)}};
}

std::vector<KeyValue> hand_keys(const Placement& p) { return {{"site_m", toml_of(p.site_m)}}; }

Result<Placement> place(const PlaceOrder& order, const model::mesh::SurfaceMesh& organ) {
  Placement placement;
  std::error_code failed;
  placement.mesh_path =
      std::filesystem::absolute(order.mesh_path, failed).lexically_normal().string();
  placement.unit_m = order.unit_m;
  if (!is_utf8(placement.mesh_path))
    return Error{fmt::format("{}: a scene is UTF-8, and this name is not; rename the file",
                             order.mesh_path)};
  auto overrides = overrides_of("organ", organ_keys(placement));
  const auto scene = model::scene::load_scene(order.scene_path, overrides);
  if (!scene) return scene.error();
  if (const auto error = place_under_hand(organ, order, *scene, placement)) return *error;
  overrides = overrides_of("organ", organ_keys(placement));
  const auto site = overrides_of("hand", hand_keys(placement));
  overrides.insert(overrides.end(), site.begin(), site.end());
  const auto placed = model::scene::load_scene(order.scene_path, overrides);
  if (!placed) return placed.error();
  const auto before = model::scene::load_scene(order.scene_path, {});
  placement.misfits = misfits_of(before ? &*before : nullptr, *placed);
  return placement;
}

std::string toml_of(const Placement& placement) {
  std::string text = "[organ]\n";
  for (const auto& [key, value] : organ_keys(placement))
    text += fmt::format("{} = {}\n", key, value);
  text += "\n[hand]\n";
  for (const auto& [key, value] : hand_keys(placement))
    text += fmt::format("{} = {}\n", key, value);
  return text;
}

}  // namespace tact::tools::mesh
