// SPDX-License-Identifier: Apache-2.0
// A pad of skin with what lies under it, cut from a forearm: 80 x 120 x 30 mm, top towards +z.
//
//     z' = z + s (5 (x/40)^2 + 2 (y/60)^2),  s = (z + 15) / 30
//
// bends the top of a rounded block into a gentle dome and leaves its bottom flat.
#include "tools/make_meshes/field.h"

namespace tact::tools::make_meshes {
namespace {

using model::Vec3;

constexpr std::size_t kVertices = 3000;
constexpr Vec3 kHalf_mm{40, 60, 15};
constexpr double kRound_mm = 9.0;  // of the block's edges

double skin_mm(const Vec3& p) {
  const double u = p.x / kHalf_mm.x, v = p.y / kHalf_mm.y;
  const double height = 0.5 + 0.5 * p.z / kHalf_mm.z;  // s
  const Vec3 q{std::abs(p.x) - kHalf_mm.x + kRound_mm, std::abs(p.y) - kHalf_mm.y + kRound_mm,
               std::abs(p.z + height * (5.0 * u * u + 2.0 * v * v)) - kHalf_mm.z + kRound_mm};
  const Vec3 out{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)};
  return norm(out) + std::min(std::max({q.x, q.y, q.z}), 0.0) - kRound_mm;
}

// Fine where it is touched, coarse below.
double edge_ratio(const Vec3& p) { return std::clamp(1.0 - 0.05 * p.z, 1.0, 1.8); }

}  // namespace

model::Result<Shape> make_skin_shape() {
  const Body skin{skin_mm, edge_ratio, {-45, -65, -20}, {45, 65, 20}, 3.1, {}};
  return make_grown(skin, kVertices, 0);
}

}  // namespace tact::tools::make_meshes
