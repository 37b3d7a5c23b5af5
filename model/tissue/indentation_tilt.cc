// SPDX-License-Identifier: Apache-2.0
#include "model/tissue/indentation_tilt.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tact::model::tissue {
namespace {

constexpr double kMinSpread = 1e-6;  // of what a disc of surface has: below, there is no plane

/// Moments of r over the surface around a point, in two axes of its tangent plane.
struct Moments {
  double count = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  double r = 0.0, xr = 0.0, yr = 0.0;

  void add(double at_x, double at_y, double value) {
    count += 1.0, x += at_x, y += at_y, r += value;
    xx += at_x * at_x, xy += at_x * at_y, yy += at_y * at_y;
    xr += at_x * value, yr += at_y * value;
  }
};

}  // namespace

std::vector<Vec3> indentation_tilt(const ComplianceMap& map, const contact::SurfaceView& surface) {
  std::vector<Vec3> out(map.vertices());
  // Sorted along x, a slab of surface moves over the organ: no vertex is held against all others.
  const auto x_m = [&](std::size_t v) { return surface.vertex_m[v].x; };
  std::vector<std::size_t> by_x(out.size());
  std::iota(by_x.begin(), by_x.end(), 0);
  std::ranges::sort(by_x, {}, x_m);
  auto first = by_x.begin();
  for (const std::size_t v : by_x) {
    const Vec3 &at_m = surface.vertex_m[v], &n = surface.vertex_normal[v];
    // Across whichever axis is not near n.
    const Vec3 e1 = normalized(cross(n, std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    const Vec3 e2 = cross(n, e1);
    Moments m;
    // The slab only moves on, as the vertices come in its order.
    while (x_m(*first) < at_m.x - kTiltReach_m) ++first;
    for (auto near = first; near != by_x.end() && x_m(*near) <= at_m.x + kTiltReach_m; ++near) {
      const std::size_t w = *near;
      const Vec3 away_m = surface.vertex_m[w] - at_m;
      if (dot(away_m, away_m) > kTiltReach_m * kTiltReach_m ||
          dot(surface.vertex_normal[w], n) < contact::kFacing)
        continue;
      m.add(dot(away_m, e1), dot(away_m, e2), static_cast<double>(map.regular_times_E_per_m[w]));
    }
    const double xx = m.xx - m.x * m.x / m.count, yy = m.yy - m.y * m.y / m.count;
    const double xy = m.xy - m.x * m.y / m.count, determinant = xx * yy - xy * xy;
    const double disc = m.count * kTiltReach_m * kTiltReach_m;
    // Too few vertices, or all on a line: no slope is reported.
    if (!(determinant > kMinSpread * disc * disc)) continue;
    const double xr = m.xr - m.x * m.r / m.count, yr = m.yr - m.y * m.r / m.count;
    // CF-6  t = grad r / 2, grad r by least squares over the disc of surface
    out[v] = 0.5 / determinant * ((yy * xr - xy * yr) * e1 + (xx * yr - xy * xr) * e2);
  }
  return out;
}

Vec3 tilt_times_E_per_m2(const contact::VertexCompliance& vertex, const Vec3& n) RT_SAFE {
  const std::array<double, 6> share{n.x * n.x,     n.y * n.y,     n.z * n.z,
                                    2 * n.y * n.z, 2 * n.z * n.x, 2 * n.x * n.y};
  Vec3 slope;
  for (std::size_t k = 0; k < share.size(); ++k) slope += share[k] * vertex.slope_times_E_per_m2(k);
  return tangential(0.5 * slope, n);
}

}  // namespace tact::model::tissue
