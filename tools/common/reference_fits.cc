#include "tools/common/reference_fits.h"

#include <fmt/format.h>

#include <cmath>

namespace tact::tools {
namespace {

using model::Error;
using model::Scene;
using model::Vec3;

constexpr double kSamePoint_m = 1e-6;
constexpr double kSame_ratio = 1e-6;

bool is_same(double a, double b) { return std::abs(a - b) <= kSame_ratio * std::abs(b); }

bool is_same(const Vec3& a, const Vec3& b) { return norm(a - b) < kSamePoint_m; }

Error differs(const Scene& scene, const std::string& what) {
  return {fmt::format("{0}: {1}; solve it again: tact-reference {0} --out FILE", scene.path, what)};
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
                                        site.vertex, reference.mesh));
  }
  if (!scene.elastic) return std::nullopt;
  const auto& elastic = *scene.elastic;
  if (!is_same(reference.poisson_ratio, elastic.poisson_ratio))
    return differs(scene, fmt::format("elastic.poisson_ratio is {:g}, the reference's {:g}",
                                      elastic.poisson_ratio, reference.poisson_ratio));
  if (modulus == ModulusOf::kSame &&
      !is_same(reference.youngs_modulus_Pa, elastic.youngs_modulus_Pa))
    return differs(scene, fmt::format("elastic.youngs_modulus_Pa is {:g}, the reference's {:g}",
                                      elastic.youngs_modulus_Pa, reference.youngs_modulus_Pa));
  if (!is_same(reference.fixed_min_m, elastic.fixed_min_m) ||
      !is_same(reference.fixed_max_m, elastic.fixed_max_m))
    return differs(scene, "the reference was solved with another held box [elastic]");
  return std::nullopt;
}

}  // namespace tact::tools
