// SPDX-License-Identifier: Apache-2.0
#include "tools/make_meshes/loft.h"

#include <cmath>
#include <numbers>

namespace tact::tools::make_meshes {

using model::Vec3;

Shape make_loft(const Vec3& bottom_mm, const std::vector<std::vector<Vec3>>& ring_mm,
                const Vec3& top_mm) {
  Shape shape;
  shape.vertex_mm.push_back(bottom_mm);
  for (const auto& ring : ring_mm)
    shape.vertex_mm.insert(shape.vertex_mm.end(), ring.begin(), ring.end());
  shape.vertex_mm.push_back(top_mm);
  const auto points = static_cast<std::uint32_t>(ring_mm.front().size());
  const auto rings = static_cast<std::uint32_t>(ring_mm.size());
  const auto at = [&](std::uint32_t r, std::uint32_t i) { return 1 + r * points + i % points; };
  const auto distance = [&](std::uint32_t a, std::uint32_t b) {
    return norm(shape.vertex_mm[a] - shape.vertex_mm[b]);
  };
  for (std::uint32_t i = 0; i < points; ++i) {
    shape.triangle.push_back({0, at(0, i + 1), at(0, i)});
    shape.triangle.push_back({rings * points + 1, at(rings - 1, i), at(rings - 1, i + 1)});
  }
  for (std::uint32_t r = 0; r + 1 < rings; ++r) {
    for (std::uint32_t i = 0; i < points; ++i) {
      const std::uint32_t a = at(r, i), b = at(r, i + 1), c = at(r + 1, i + 1), d = at(r + 1, i);
      if (distance(a, c) <= distance(b, d) + 1e-6)  // the shorter diagonal
        shape.triangle.insert(shape.triangle.end(), {{a, b, c}, {a, c, d}});
      else
        shape.triangle.insert(shape.triangle.end(), {{a, b, d}, {b, c, d}});
    }
  }
  return shape;
}

Shape make_turned(const Turned& tool) {
  std::vector<std::vector<Vec3>> ring;
  const auto add_ring = [&](double z_mm, double radius_mm) {
    ring.emplace_back();
    for (int i = 0; i < tool.points; ++i) {
      const double angle_rad = 2.0 * std::numbers::pi * double(i) / tool.points;
      ring.back().push_back(
          {radius_mm * std::cos(angle_rad), radius_mm * std::sin(angle_rad), z_mm});
    }
  };
  for (const double angle_deg : tool.ball_angle_deg) {
    const double angle_rad = angle_deg * std::numbers::pi / 180.0;
    add_ring(tool.ball_mm * (1.0 - std::cos(angle_rad)), tool.ball_mm * std::sin(angle_rad));
  }
  Turn last = tool.turns.front();
  for (const Turn& turn : tool.turns) {
    for (int i = 1; i <= turn.steps; ++i) {
      const double way = double(i) / turn.steps;
      add_ring(last.z_mm + way * (turn.z_mm - last.z_mm),
               last.radius_mm + way * (turn.radius_mm - last.radius_mm));
    }
    last = turn;
  }
  return make_loft({0, 0, 0}, ring, {0, 0, tool.top_mm});
}

}  // namespace tact::tools::make_meshes
