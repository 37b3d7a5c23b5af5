// SPDX-License-Identifier: Apache-2.0
// The zero surface of a field: marching tetrahedra on a cubic grid, then planes that cut it open.
//
// Each cube is six tetrahedra round its diagonal (0,0,0)-(1,1,1), the same in every cube, so faces
// match. A tetrahedron with inside and outside corners holds one or two triangles; their corners
// lie on its edges, one per edge of the grid: a closed surface by construction.
#include "tools/make_meshes/field.h"

#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

namespace tact::tools::make_meshes {
namespace {

using model::cross;
using model::dot;
using model::Vec3;
using model::contact::TriangleCorners;

// Corner c of a cube lies at (c & 1, c >> 1 & 1, c >> 2).
constexpr std::array<std::array<std::size_t, 4>, 6> kTetrahedra{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

class Grid {
 public:
  explicit Grid(const Body& body) : low_(body.low_mm), cell_mm_(body.cell_mm) {
    const Vec3 size = body.high_mm - body.low_mm;
    const auto nodes = [&](double length) {
      return static_cast<std::size_t>(std::ceil(length / cell_mm_)) + 1;
    };
    nx_ = nodes(size.x), ny_ = nodes(size.y), nz_ = nodes(size.z);
    value_.resize(nx_ * ny_ * nz_);
    for (std::size_t n = 0; n < value_.size(); ++n) value_[n] = body.distance_mm(place(n));
  }

  Shape surface() {
    for (std::size_t k = 0; k + 1 < nz_; ++k) {
      for (std::size_t j = 0; j + 1 < ny_; ++j)
        for (std::size_t i = 0; i + 1 < nx_; ++i) visit_cube(i, j, k);
    }
    return std::move(shape_);
  }

 private:
  Vec3 place(std::size_t node) const {
    const std::size_t i = node % nx_, j = node / nx_ % ny_, k = node / nx_ / ny_;
    return low_ + cell_mm_ * Vec3{double(i), double(j), double(k)};
  }

  bool inside(std::size_t node) const { return value_[node] < 0.0; }

  void visit_cube(std::size_t i, std::size_t j, std::size_t k) {
    std::array<std::size_t, 8> corner{};
    for (std::size_t c = 0; c < 8; ++c)
      corner[c] = ((k + (c >> 2)) * ny_ + j + (c >> 1 & 1)) * nx_ + i + (c & 1);
    const auto is_inside = [&](std::size_t c) { return inside(c); };
    const auto all = std::count_if(corner.begin(), corner.end(), is_inside);
    if (all == 0 || all == 8) return;  // most cubes
    for (const auto& t : kTetrahedra) {
      std::vector<std::size_t> in, out;
      for (const std::size_t c : t) (inside(corner[c]) ? in : out).push_back(corner[c]);
      if (in.size() == 2)
        add({at(in[0], out[0]), at(in[0], out[1]), at(in[1], out[1]), at(in[1], out[0])}, in[0],
            out[0]);
      if (in.size() == 1)
        add({at(in[0], out[0]), at(in[0], out[1]), at(in[0], out[2])}, in[0], out[0]);
      if (in.size() == 3)
        add({at(in[0], out[0]), at(in[1], out[0]), at(in[2], out[0])}, in[0], out[0]);
    }
  }

  // A flat polygon, turned so that its normal points from an inside node to an outside one.
  void add(std::vector<std::uint32_t> loop, std::size_t in, std::size_t out) {
    const auto& p = shape_.vertex_mm;
    const Vec3 n = cross(p[loop[1]] - p[loop[0]], p[loop[2]] - p[loop[0]]);
    const Vec3 middle = 0.5 * (p[loop[0]] + p[loop[2]]);
    if (dot(n, place(out) - middle) < dot(n, place(in) - middle))
      std::reverse(loop.begin(), loop.end());
    for (std::size_t c = 1; c + 1 < loop.size(); ++c)
      shape_.triangle.push_back({loop[0], loop[c], loop[c + 1]});
  }

  // The vertex on the edge between two nodes; kept off its ends, where triangles would vanish.
  std::uint32_t at(std::size_t in, std::size_t out) {
    const std::size_t low = std::min(in, out), high = std::max(in, out);
    const auto [entry, fresh] = made_.try_emplace(
        low * value_.size() + high, static_cast<std::uint32_t>(shape_.vertex_mm.size()));
    if (fresh) {
      const double t = std::clamp(value_[low] / (value_[low] - value_[high]), 0.15, 0.85);
      shape_.vertex_mm.push_back(place(low) + t * (place(high) - place(low)));
    }
    return entry->second;
  }

  Vec3 low_;
  double cell_mm_;
  std::size_t nx_ = 0, ny_ = 0, nz_ = 0;
  std::vector<double> value_;
  std::unordered_map<std::size_t, std::uint32_t> made_;  // looked up, never walked
  Shape shape_;
};

// Take away what lies beyond the plane; triangles that straddle it are trimmed.
void open_at(const Cut& cut, Shape& shape) {
  std::vector<double> beyond_mm;
  for (const Vec3& p : shape.vertex_mm) {
    const double d_mm = dot(p - cut.centre_mm, cut.outward);
    beyond_mm.push_back(norm(p - cut.centre_mm) < cut.reach_mm ? d_mm : -1.0);
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> made;
  const auto on_plane = [&](std::uint32_t a, std::uint32_t b) {
    const auto [entry, fresh] =
        made.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(shape.vertex_mm.size()));
    if (fresh) {
      const auto [from, to] = entry->first;
      const double t = beyond_mm[from] / (beyond_mm[from] - beyond_mm[to]);
      shape.vertex_mm.push_back(shape.vertex_mm[from] +
                                t * (shape.vertex_mm[to] - shape.vertex_mm[from]));
    }
    return entry->second;
  };
  std::vector<TriangleCorners> kept;
  for (const TriangleCorners& t : shape.triangle) {
    std::vector<std::uint32_t> loop;
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint32_t a = t[e], b = t[(e + 1) % 3];
      const bool a_stays = beyond_mm[a] < 0.0, b_stays = beyond_mm[b] < 0.0;
      if (a_stays) loop.push_back(a);
      if (a_stays != b_stays) loop.push_back(on_plane(a, b));
    }
    for (std::size_t c = 1; c + 1 < loop.size(); ++c)
      kept.push_back({loop[0], loop[c], loop[c + 1]});
  }
  shape.triangle = std::move(kept);
}

void drop_unused(Shape& shape) {
  constexpr std::uint32_t kUnused = 0xFFFFFFFFu;
  std::vector<std::uint32_t> place(shape.vertex_mm.size(), kUnused);
  std::vector<Vec3> used_mm;
  for (TriangleCorners& t : shape.triangle) {
    for (std::uint32_t& v : t) {
      if (place[v] == kUnused) {
        place[v] = static_cast<std::uint32_t>(used_mm.size());
        used_mm.push_back(shape.vertex_mm[v]);
      }
      v = place[v];
    }
  }
  shape.vertex_mm = std::move(used_mm);
}

}  // namespace

Shape rough_surface(const Body& body) {
  Shape shape = Grid(body).surface();
  for (const Cut& cut : body.cuts) open_at(cut, shape);
  drop_unused(shape);
  return shape;
}

Vec3 pulled_to_surface(const Field& distance_mm, Vec3 p_mm, int steps) {
  constexpr double kStep_mm = 1e-4;
  for (int i = 0; i < steps; ++i) {
    const double d_mm = distance_mm(p_mm);
    const Vec3 slope = Vec3{distance_mm(p_mm + Vec3{kStep_mm, 0, 0}) - d_mm,
                            distance_mm(p_mm + Vec3{0, kStep_mm, 0}) - d_mm,
                            distance_mm(p_mm + Vec3{0, 0, kStep_mm}) - d_mm} /
                       kStep_mm;
    // Newton: p - f grad f / |grad f|^2; where the slope all but vanishes, stay.
    p_mm -= d_mm / std::max(dot(slope, slope), 0.05) * slope;
  }
  return p_mm;
}

const Cut& nearest_cut(const Body& body, const Vec3& p_mm) {
  return *std::min_element(body.cuts.begin(), body.cuts.end(), [&](const Cut& a, const Cut& b) {
    return norm(p_mm - a.centre_mm) < norm(p_mm - b.centre_mm);
  });
}

}  // namespace tact::tools::make_meshes
