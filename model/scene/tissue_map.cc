// SPDX-License-Identifier: Apache-2.0
#include "model/scene/tissue_map.h"

#include <fmt/format.h>

#include <filesystem>

#include "model/scene/compliance_file.h"
#include "model/tissue/elastic_layer.h"

namespace tact::model::scene {

namespace {

constexpr double kLayerRingsPerRadius = 2.0;  // of the tip

/// Makes the scene's own map beside it. One that the scene names elsewhere may be of other scenes,
/// as the shipped ones are, and is never the output.
std::string remedy_of(const Scene& scene) {
  const std::filesystem::path own =
      std::filesystem::path(scene.path).replace_extension(".compliance");
  std::string command = fmt::format("tact-lab condense {} --out {}", scene.path, own.string());
  std::error_code failed;
  if (std::filesystem::absolute(own, failed).lexically_normal() == scene.compliance.map_path)
    return command;
  return fmt::format("write compliance.map = \"{}\", then {}", own.filename().string(), command);
}

}  // namespace

Result<tissue::ComplianceMap> read_scene_map(const Scene& scene) {
  const std::string& path = scene.compliance.map_path;
  const std::string command = remedy_of(scene);
  // From the scene to the file to what is in it: each is asked only where the one before is good.
  if (!scene.elastic)
    return Error{scene.path +
                 ": compliance needs a section [elastic]: modulus, Poisson's ratio "
                 "and where the organ is held"};
  const ElasticSettings& e = *scene.elastic;
  if (scene.compliance.layer_thickness_m > 0.0) {
    if (!e.inclusions.empty())
      return Error{
          fmt::format("{}: a layer knows no [[elastic.inclusion]]; {}", scene.path, command)};
    return tissue::layer_map({scene.compliance.layer_thickness_m, e.poisson_ratio},
                             scene.organ_mesh.view(),
                             scene.tool.spheres[0].radius_m / kLayerRingsPerRadius);
  }
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed))
    return Error{
        fmt::format("{}: compliance.map names {}, no such file; correct it, or make it: {}",
                    scene.path, path, command)};
  auto map = read_compliance_map(path);
  if (!map) return Error{fmt::format("{}: {}", map.error().message, command)};
  if (map->mesh_hash != surface_hash(scene.organ_mesh.view()))
    return Error{fmt::format("{} belongs to another organ mesh; make one: {}", path, command)};
  // E may change, since the map holds r E; nu and what is held may not. Equal to the bit, as both
  // come from the same TOML.
  if (map->poisson_ratio != e.poisson_ratio || !(map->fixed_min_m == e.fixed_min_m) ||
      !(map->fixed_max_m == e.fixed_max_m))
    return Error{
        fmt::format("{} was made for Poisson's ratio {} or another held box than [elastic] "
                    "says; make one: {}",
                    path, map->poisson_ratio, command)};
  if (map->inclusions != inclusions_hash(e))
    return Error{
        fmt::format("{} was made for other [[elastic.inclusion]] than the scene's, or for other "
                    "ratios of their "
                    "modulus to elastic.youngs_modulus_Pa; make one: {}",
                    path, command)};
  return map;
}

Result<double> scene_tip_radius_m(const Scene& scene) {
  const std::vector<contact::ProbeSphere>& spheres = scene.tool.spheres;
  for (const contact::ProbeSphere& sphere : spheres)
    // One family of curves is made for one tip.
    if (sphere.radius_m != spheres[0].radius_m)
      return Error{fmt::format(
          "tool.sphere has radii of {} and {} m, but compliance, varies_by_place and "
          "rhombus.area_m2 know one tip; give every sphere one radius_m, or choose another law and "
          "leave these keys out",
          spheres[0].radius_m, sphere.radius_m)};
  return spheres[0].radius_m;
}

Result<tissue::ComplianceFamily> read_scene_family(const Scene& scene) {
  const auto tip_radius_m = scene_tip_radius_m(scene);
  if (!tip_radius_m) return Error{scene.path + ": " + tip_radius_m.error().message};
  auto map = read_scene_map(scene);
  if (!map) return map.error();
  auto family = make_compliance_family(*map, {.youngs_modulus_Pa = scene.elastic->youngs_modulus_Pa,
                                              .tip_radius_m = *tip_radius_m,
                                              .working_depth_m = scene.compliance.working_depth_m,
                                              .curves = scene.compliance.curves,
                                              .table_knots = scene.table_knots});
  if (!family) return Error{scene.path + ": " + family.error().message};
  return family;
}

}  // namespace tact::model::scene
