// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/self_check/block.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tact::tools::reference {
namespace {

using model::Vec3;
using model::contact::TriangleCorners;

constexpr std::uint32_t kDiscRings = 8;
constexpr std::uint32_t kSides = 6;

/// First vertex of ring k in a disc whose ring k has 6 k vertices.
constexpr std::uint32_t ring_start(std::uint32_t k) { return k == 0 ? 0 : 1 + 3 * k * (k - 1); }
constexpr std::uint32_t kDiscVertices = ring_start(kDiscRings + 1);

void add_disc(double radius_m, double z_m, bool up, std::vector<Vec3>& vertex,
              std::vector<TriangleCorners>& triangle) {
  const auto base = static_cast<std::uint32_t>(vertex.size());
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    triangle.push_back({base + a, base + (up ? b : c), base + (up ? c : b)});
  };
  vertex.push_back({0, 0, z_m});
  // Ring k has 6 k vertices: triangles of about one size out to the rim.
  for (std::uint32_t k = 1; k <= kDiscRings; ++k) {
    const double r_m = radius_m * k / kDiscRings;
    for (std::uint32_t i = 0; i < kSides * k; ++i) {
      const double angle_rad = 2.0 * std::numbers::pi * i / (kSides * k);
      vertex.push_back({r_m * std::cos(angle_rad), r_m * std::sin(angle_rad), z_m});
    }
    for (std::uint32_t side = 0; side < kSides; ++side) {
      const auto inner = [&](std::uint32_t i) {
        return k == 1 ? 0 : ring_start(k - 1) + (side * (k - 1) + i) % (kSides * (k - 1));
      };
      const auto outer = [&](std::uint32_t i) {
        return ring_start(k) + (side * k + i) % (kSides * k);
      };
      for (std::uint32_t i = 0; i < k; ++i) {
        add(inner(i), outer(i), outer(i + 1));
        if (i + 1 < k) add(inner(i), outer(i + 1), inner(i + 1));
      }
    }
  }
}

}  // namespace

model::Result<Organ> make_block(double radius_m, double height_m, const Elasticity& material) {
  std::vector<Vec3> vertex;
  std::vector<TriangleCorners> triangle;
  add_disc(radius_m, 0.0, true, vertex, triangle);
  add_disc(radius_m, -height_m, false, vertex, triangle);
  constexpr std::uint32_t kRim = kSides * kDiscRings;
  const std::uint32_t top = ring_start(kDiscRings), bottom = kDiscVertices + top;
  for (std::uint32_t i = 0; i < kRim; ++i) {
    const std::uint32_t next = (i + 1) % kRim;
    triangle.push_back({top + i, bottom + i, bottom + next});
    triangle.push_back({top + i, bottom + next, top + next});
  }
  auto surface = model::mesh::make_surface_mesh(std::move(vertex), std::move(triangle));
  if (!surface) return surface.error();
  const double far_m = 2.0 * (radius_m + height_m);
  return Organ{.surface = std::move(*surface),
               .hash = {},
               .held = {{-far_m, -far_m, -far_m}, {far_m, far_m, -height_m * (1.0 - 1e-9)}},
               .material = material,
               .size_ratio = std::max(1.0, radius_m / 0.05)};
}

}  // namespace tact::tools::reference
