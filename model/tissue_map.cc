#include "model/tissue_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "model/compliance_file.h"

namespace tact::model {

Result<ComplianceMap> read_scene_map(const Scene& scene) {
  const std::string& path = scene.compliance.map_path;
  const std::string command = fmt::format("tact-condense {} --out {}", scene.path, path);
  if (!scene.elastic)
    return Error{scene.path +
                 ": compliance needs a section [elastic]: modulus, Poisson's ratio "
                 "and where the organ is held"};
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed))
    return Error{
        fmt::format("{}: compliance.map names {}, no such file; correct it, or make it: {}",
                    scene.path, path, command)};
  auto map = read_compliance_map(path);
  if (!map) return Error{fmt::format("{}: {}", map.error().sentence, command)};
  const ElasticSettings& e = *scene.elastic;
  if (map->mesh_hash != surface_hash(scene.organ_mesh.view()))
    return Error{fmt::format("{} belongs to another organ mesh; make one: {}", path, command)};
  if (map->poisson_ratio != e.poisson_ratio || !(map->fixed_min_m == e.fixed_min_m) ||
      !(map->fixed_max_m == e.fixed_max_m))
    return Error{
        fmt::format("{} was made for Poisson's ratio {} or another held box than [elastic] "
                    "says; make one: {}",
                    path, map->poisson_ratio, command)};
  return map;
}

Result<ComplianceFamily> read_scene_family(const Scene& scene) {
  const std::vector<ProbeSphere>& spheres = scene.tool.spheres;
  for (const ProbeSphere& sphere : spheres)
    if (sphere.radius_m != spheres[0].radius_m)
      return Error{fmt::format(
          "{}: tool.sphere has radii of {} and {} m, but compliance and varies_by_place know one "
          "tip; give every sphere one radius_m, or choose another law and leave "
          "varies_by_place out",
          scene.path, spheres[0].radius_m, sphere.radius_m)};
  auto map = read_scene_map(scene);
  if (!map) return map.error();
  auto family = make_compliance_family(*map, {.youngs_modulus_Pa = scene.elastic->youngs_modulus_Pa,
                                              .tip_radius_m = spheres[0].radius_m,
                                              .working_depth_m = scene.compliance.working_depth_m,
                                              .curves = scene.compliance.curves,
                                              .table_knots = scene.table_knots});
  if (!family) return Error{scene.path + ": " + family.error().sentence};
  return family;
}

std::vector<float> stiffness_factors(const ComplianceFamily& family,
                                     const std::vector<float>& coordinate, double depth_m) {
  std::vector<double> curve_N;
  curve_N.reserve(family.curve.size());
  for (const ComplianceCurve& c : family.curve) curve_N.push_back(c.respond(depth_m).force_N);
  std::vector<float> factor;
  for (const float kappa : coordinate) {
    const auto k = std::min(static_cast<std::size_t>(kappa), curve_N.size() - 2);
    const double f = static_cast<double>(kappa) - static_cast<double>(k);
    factor.push_back(static_cast<float>(curve_N[k] + f * (curve_N[k + 1] - curve_N[k])));
  }
  std::vector<float> sorted = factor;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const float median = *middle;
  for (float& f : factor) f /= median;
  return factor;
}

}  // namespace tact::model
