// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/organ/surface_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tact::tools::reference {

using model::Vec3;

std::optional<SurfaceRays::Meeting> SurfaceRays::thickness(const Vec3& from,
                                                           const Vec3& direction) const {
  constexpr double kNever_m = std::numeric_limits<double>::infinity();
  double out_m = kNever_m, in_m = -kNever_m;
  // The nearest way out ahead, and the last way in before it.
  for (int pass = 0; pass < 2; ++pass)
    for (std::size_t t = 0; t < surface_.triangle.size(); ++t) {
      const double facing = dot(surface_.face_normal[t], direction);
      if ((facing > 0.0) != (pass == 0)) continue;
      const auto& corner = surface_.triangle[t];
      const Vec3& a = surface_.vertex_m[corner[0]];
      const Vec3 e1 = surface_.vertex_m[corner[1]] - a, e2 = surface_.vertex_m[corner[2]] - a;
      const Vec3 p = cross(direction, e2);
      const double det = dot(e1, p);
      if (det == 0.0) continue;
      const Vec3 r = from - a, q = cross(r, e1);
      const double u = dot(r, p) / det, v = dot(direction, q) / det, way_m = dot(e2, q) / det;
      if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
      if (pass == 0 && way_m > 0.0) out_m = std::min(out_m, way_m);
      if (pass == 1 && way_m < out_m) in_m = std::max(in_m, way_m);
    }
  if (!std::isfinite(out_m) || !std::isfinite(in_m)) return std::nullopt;
  return Meeting{.away_m = in_m, .thick_m = out_m - in_m};
}

}  // namespace tact::tools::reference
