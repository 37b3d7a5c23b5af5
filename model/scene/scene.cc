// SPDX-License-Identifier: Apache-2.0
#include "model/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "model/indent/table_law.h"
#include "model/io/input_file.h"
#include "model/mesh/obj.h"
#include "model/mesh/turn.h"
#include "model/reader/scene_text.h"
#include "model/scene/compliance_file.h"
#include "model/scene/laws.h"
#include "model/scene/scene_keys.h"

namespace tact::model::scene {
namespace {

namespace fs = std::filesystem;

/// The mesh's own error names its file and line; one that is not there is the scene's error.
Result<mesh::ObjMesh> load_mesh(const MeshText& text, const std::string& path) {
  std::error_code failed;
  if (!fs::is_regular_file(path, failed)) {
    return Error{
        fmt::format("{}: {} is no file; name an OBJ file, absolute or from the folder of the scene",
                    text.position.where, path)};
  }
  return mesh::load_obj(path, text.unit_m);
}

std::optional<Error> load_meshes(const SceneText& text, Scene& scene) {
  scene.organ.mesh_path = reader::path_beside(scene.path, text.organ_mesh.file);
  scene.tool.mesh_path = reader::path_beside(scene.path, text.tool_mesh.file);
  Result<mesh::ObjMesh> organ = load_mesh(text.organ_mesh, scene.organ.mesh_path);
  if (!organ) return organ.error();
  Result<mesh::ObjMesh> tool = load_mesh(text.tool_mesh, scene.tool.mesh_path);
  if (!tool) return tool.error();
  scene.organ.is_turned = organ->flipped;
  if (const Vec3& turn_deg = text.organ_orientation_deg; norm(turn_deg) > 0.0)
    mesh::turn(organ->mesh, mesh::turn_of(turn_deg));
  mesh::shift(organ->mesh, scene.organ.position_m);
  scene.organ_mesh = std::move(organ->mesh);
  scene.tool_mesh = std::move(tool->mesh);
  if (!scene.look.has_vertex_colors) return std::nullopt;
  if (organ->vertex_color.empty())
    return Error{fmt::format(
        "{}: look.vertex_colors = true, but {} has no colours: \"v x y z red green blue\", 0 to 1, "
        "at each vertex; tact-mesh keeps those of a scan, or leave the key out",
        text.vertex_colors_position.where, scene.organ.mesh_path)};
  scene.look.vertex_color = std::move(organ->vertex_color);
  return std::nullopt;
}

/// The device holds the tool there: force and torque are taken at this point.
void put_origin_at(const Vec3& handle_m, Scene& scene) {
  for (contact::ProbeSphere& sphere : scene.tool.spheres) sphere.offset_m -= handle_m;
  if (scene.tool.blade) {
    scene.tool.blade->a_m -= handle_m;
    scene.tool.blade->b_m -= handle_m;
  }
  mesh::shift(scene.tool_mesh, -handle_m);
}

/// Would another map give other forces?
bool needs_compliance(const Scene& scene) {
  return follows_elastic(scene) || scene.law == kAutoLaw;
}

/// A map is of one organ: on another mesh the law is felt as it is at every place. A map that
/// cannot be read stays an error of the law.
void vary_on_the_own_organ_only(Scene& scene) {
  if (!scene.varies_by_place || scene.compliance.layer_thickness_m > 0.0) return;
  const auto map = read_compliance_map(scene.compliance.map_path);
  if (!map || map->mesh_hash == surface_hash(scene.organ_mesh.view())) return;
  scene.varies_by_place = false;
  scene.note = fmt::format(
      "{}: {} is of another organ than {}, so varies_by_place is off: every place acts as a "
      "half-space of this tissue; make a map: tact-lab condense {} --out FILE",
      scene.path, scene.compliance.map_path, scene.organ.mesh_path, scene.path);
}

/// Text, overrides, meshes and the compliance map if felt: the same hash, the same forces.
std::string whole_hash(const std::string& text_hash, const Scene& scene) {
  reader::TextHash hash;
  hash.add(text_hash);
  for (const mesh::SurfaceMesh* mesh : {&scene.organ_mesh, &scene.tool_mesh}) {
    const auto bytes = [&hash](const auto& list) {
      hash.add({reinterpret_cast<const char*>(list.data()), list.size() * sizeof list[0]});
    };
    bytes(mesh->vertex_m);
    bytes(mesh->triangle);
  }
  // law = "auto" counts as felt: tact-lab plan tries the compliance law, too.
  if (needs_compliance(scene)) hash.add(compliance_checksum(scene.compliance.map_path));
  if (const auto table = io::read_file(scene.laws.of<indent::TableParameters>().data))
    hash.add(*table);
  return hash.hex();
}

void visit_all(reader::SceneVisit& visit, DeviceKeys device_keys, SceneText& text) {
  Keys::visit_root(visit, [&](Keys& root) { visit_scene(root, device_keys, text); });
}

/// The reference, indented as a scene is; `margin` is that of the row before.
std::string reference_line(const reader::ReferenceRow& row, std::string& margin) {
  const std::string times = row.fallback.empty() ? "" : "; " + row.fallback;
  if (row.key.empty()) {
    margin = "  ";
    return fmt::format("\n{:<34} {}{}\n", row.allowed, row.meaning, times);
  }
  if (row.fallback.empty()) {  // the value that decides about the keys below it
    margin = "    ";
    return fmt::format("  {:<32} {}\n", fmt::format("{} = {}", row.key, row.allowed), row.meaning);
  }
  return fmt::format("{:<34} {:<29}  {:<8}  {}\n", margin + row.key, row.allowed, row.fallback,
                     row.meaning);
}

}  // namespace

Result<Scene> load_scene(const std::string& path, const std::vector<std::string>& overrides,
                         DeviceKeys device_keys) {
  const Result<reader::SceneDocument> document = reader::load_scene_document(path, overrides);
  if (!document) return document.error();
  SceneText text;
  reader::SceneVisit visit(&*document);
  visit_all(visit, device_keys, text);
  if (auto problem = visit.problem()) return *problem;

  Scene& scene = text.scene;
  scene.path = path;
  scene.hand_site_m = text.script.site_m;
  scene.hand_inward = normalized(text.script.inward);
  // Strokes before meshes: errors of the text are reported before files are read that take long.
  scene.hand.path = way_points(text.script, scene.tool.spheres, scene.limits, visit);
  if (auto problem = visit.problem()) return *problem;
  if (auto failed = load_meshes(text, scene)) return *failed;
  if (auto failed =
          place_tasks(scene.tasks, scene.organ_mesh, scene.organ.position_m, scene.limits.force_N))
    return *failed;
  put_origin_at(text.script.handle_m, scene);
  vary_on_the_own_organ_only(scene);
  scene.hash = whole_hash(document->hash, scene);
  return std::move(scene);
}

bool Scene::describes(std::string_view law_name) const {
  return std::ranges::find(described, law_name) != described.end();
}

std::string scene_reference(DeviceKeys device_keys) {
  SceneText text;
  reader::SceneVisit visit(nullptr);
  visit_all(visit, device_keys, text);
  std::string reference =
      "A scene is a TOML file. Numbers are SI; a key ends in its unit. The columns are key, "
      "allowed,\n"
      "default or required, meaning. W: +x to the operator, +y right, +z up, origin in the "
      "middle.\n\n";
  std::string margin;
  for (const reader::ReferenceRow& row : visit.rows()) reference += reference_line(row, margin);
  return reference;
}

}  // namespace tact::model::scene
