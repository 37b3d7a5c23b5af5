// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/place.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "model/io/file_writer.h"
#include "model/io/input_file.h"
#include "model/mesh/mesh.h"
#include "model/mesh/turn.h"
#include "model/scene/scene.h"

namespace tact::tools::mesh {
namespace {

using model::Error;
using model::Result;
using model::Vec3;

using KeyValue = std::pair<std::string, std::string>;

std::vector<KeyValue> organ_keys(const Placement& p) {
  return {{"mesh", nlohmann::json(p.mesh_path).dump()},  // quoted alike in TOML
          {"mesh_unit_m", fmt::format("{}", p.unit_m)},
          {"orientation_deg", toml_of(p.orientation_deg)},
          {"position_m", toml_of(p.position_m)}};
}

std::vector<KeyValue> hand_keys(const Placement& p) { return {{"site_m", toml_of(p.site_m)}}; }

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

std::string trimmed(std::string line) {
  line.erase(0, std::min(line.find_first_not_of(" \t"), line.size()));
  return line;
}

bool is_key(const std::string& line, const std::string& key) {
  std::string rest = trimmed(line);
  if (!rest.starts_with(key)) return false;
  rest = trimmed(rest.substr(key.size()));
  return rest.starts_with("=");
}

/// Does a value go on in the next line?
bool is_open(const std::string& line) {
  return std::count(line.begin(), line.end(), '[') > std::count(line.begin(), line.end(), ']') ||
         line.find("\"\"\"") != std::string::npos || line.find("'''") != std::string::npos;
}

std::optional<Error> set_keys(std::vector<std::string>& lines, const std::string& section,
                              const std::vector<KeyValue>& keys) {
  const std::string cure = "write the printed lines yourself";
  const auto header = std::find_if(lines.begin(), lines.end(), [&](const std::string& line) {
    return trimmed(line).starts_with("[" + section + "]");
  });
  if (header == lines.end())
    return Error{fmt::format("the scene has no line [{}]; {}", section, cure)};
  auto at = header - lines.begin();
  for (const auto& [key, value] : keys) {
    const auto begin = header + 1;
    const auto end = std::find_if(
        begin, lines.end(), [](const std::string& line) { return trimmed(line).starts_with("["); });
    const std::string text = fmt::format("{} = {}", key, value);
    const auto found = std::find_if(
        begin, end, [&key = key](const std::string& line) { return is_key(line, key); });
    if (found == end) continue;
    if (is_open(*found))
      return Error{fmt::format("{}.{} goes over several lines; {}", section, key, cure)};
    *found = text;
    at = std::max(at, found - lines.begin());
  }
  for (const auto& [key, value] : keys) {
    const auto first = lines.begin() + (header - lines.begin()) + 1;
    const bool there = std::any_of(first, lines.begin() + at + 1,
                                   [&key = key](const std::string& l) { return is_key(l, key); });
    if (!there) lines.insert(lines.begin() + ++at, fmt::format("{} = {}", key, value));
  }
  return std::nullopt;
}

/// Fills all but path and unit.
void place_under_hand(const model::mesh::SurfaceMesh& mesh, std::optional<Vec3> point_m,
                      const model::scene::Scene& scene, Placement& placement) {
  // The chosen vertex has the least of this: distance from the point, or depth below the top.
  const auto worth = [&](const Vec3& p) {
    return point_m ? norm(p - *point_m) : dot(p, scene.hand_inward);
  };
  std::size_t chosen = 0;
  for (std::size_t v = 0; v < mesh.vertex_m.size(); ++v)
    if (worth(mesh.vertex_m[v]) < worth(mesh.vertex_m[chosen])) chosen = v;
  const model::Quat turn =
      point_m ? model::mesh::turn_between(mesh.vertex_normal[chosen], -scene.hand_inward)
              : model::Quat{};
  placement.orientation_deg = model::mesh::rotation_deg_of(turn);
  placement.site_m = scene.hand_site_m;
  placement.position_m = scene.hand_site_m - rotate(turn, mesh.vertex_m[chosen]);
}

}  // namespace

double rounded_m(double x_m) { return std::round(x_m * 1e7) / 1e7 + 0.0; }

std::string toml_of(const Vec3& v) {
  return fmt::format("[{}, {}, {}]", rounded_m(v.x), rounded_m(v.y), rounded_m(v.z));
}

Result<Placement> place(const PlaceOrder& order, const model::mesh::SurfaceMesh& organ) {
  Placement placement;
  std::error_code failed;
  placement.mesh_path =
      std::filesystem::absolute(order.mesh_path, failed).lexically_normal().string();
  placement.unit_m = order.unit_m;
  const auto scene = model::scene::load_scene(
      order.scene_path, {"organ.mesh=" + nlohmann::json(placement.mesh_path).dump(),
                         fmt::format("organ.mesh_unit_m={}", placement.unit_m)});
  if (!scene) return scene.error();
  const std::optional<Vec3> point_m =
      order.point ? std::optional(*order.point * placement.unit_m) : std::nullopt;
  place_under_hand(organ, point_m, *scene, placement);
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

Result<std::string> placed_in(const std::string& scene_text, const Placement& placement) {
  std::vector<std::string> lines = lines_of(scene_text);
  if (const auto error = set_keys(lines, "organ", organ_keys(placement))) return *error;
  if (const auto error = set_keys(lines, "hand", hand_keys(placement))) return *error;
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

std::optional<Error> write_placement(const std::string& scene_path, const Placement& placement) {
  const auto before = model::io::read_file(scene_path);
  if (!before) return before.error();
  const auto after = placed_in(*before, placement);
  if (!after) return Error{fmt::format("{}: {}", scene_path, after.error().sentence)};
  if (const auto error = model::io::write_file(scene_path, *after)) return error;
  const auto loaded = model::scene::load_scene(scene_path, {});
  if (loaded) return std::nullopt;
  if (const auto error = model::io::write_file(scene_path, *before)) return error;
  return Error{fmt::format("{} stays as it was, since it would not load: {}", scene_path,
                           loaded.error().sentence)};
}

}  // namespace tact::tools::mesh
