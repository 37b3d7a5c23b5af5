#include "tools/make_meshes_loft.h"

namespace tact::tools {

using model::Vec3;

Shape make_loft(const Vec3& bottom_mm, const std::vector<std::vector<Vec3>>& ring_mm,
                const Vec3& top_mm) {
  Shape shape;
  shape.vertex_mm.push_back(bottom_mm);
  for (const auto& ring : ring_mm) {
    shape.vertex_mm.insert(shape.vertex_mm.end(), ring.begin(), ring.end());
  }
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
      if (distance(a, c) <= distance(b, d) + 1e-6) {  // the shorter diagonal
        shape.triangle.insert(shape.triangle.end(), {{a, b, c}, {a, c, d}});
      } else {
        shape.triangle.insert(shape.triangle.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
  return shape;
}

}  // namespace tact::tools
