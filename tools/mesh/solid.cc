// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/solid.h"

#include <fmt/format.h>

#include <cmath>

namespace tact::tools::mesh {

/// Of its diagonal's cube. Chosen: above what float coordinates leave of a flat sheet far from the
/// origin, and a hundredth of a sheet of paper.
constexpr double kFlat_ratio = 1e-6;

std::optional<model::Error> check_solid(const std::string& path,
                                        const model::mesh::SurfaceMesh& mesh) {
  const auto sum = summarize(mesh);
  if (sum.boundary_edges > 0) return std::nullopt;
  const double size_m = norm(sum.high_m - sum.low_m);
  // V > ratio d^3, so that NaN is no volume
  if (std::abs(sum.volume_m3) > kFlat_ratio * size_m * size_m * size_m) return std::nullopt;
  return model::Error{fmt::format(
      "{}: closed, of {} faces, and without a volume: two sheets that lie on each other; take one "
      "sheet, or a solid, in a mesh editor",
      path, sum.triangles)};
}

}  // namespace tact::tools::mesh
