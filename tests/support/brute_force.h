// SPDX-License-Identifier: Apache-2.0
// brute_force.h - distance, inside and line of sight of a mesh, by loops over its triangles.
//
// The reference for model/contact, of which it uses no code. Everything exists twice: as a plain
// loop over all triangles, and by a uniform grid of triangle lists for the many points of a test.
// brute_force_test.cc holds the grid to the loops.
//
//     w(p) = sum of Omega_i(p) / (4 pi)      generalised winding number, 1 inside and 0 outside
//     tan(Omega / 2) = det(a b c) / (|a||b||c| + (a.b)|c| + (b.c)|a| + (c.a)|b|)
//                                            a, b, c: corners seen from p
//                                            [van Oosterom, Strackee, IEEE TBME 30 (1983) 125]
//
// The grid closes an open mesh by a cone of triangles on its boundary edges: the winding number of
// the closed surface is an integer that changes only where a segment crosses it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "model/types.h"

namespace tact::tests {

class BruteForce {
 public:
  using Vec3 = model::Vec3;
  using Corners = std::array<std::uint32_t, 3>;

  struct Nearest {
    double distance_m = std::numeric_limits<double>::infinity();
    Vec3 point_m;
    std::uint32_t triangle = 0;
  };

  BruteForce(std::span<const Vec3> vertex_m, std::span<const Corners> triangle);

  bool is_closed() const { return cone_.empty(); }
  const Vec3& low_m() const { return low_m_; }
  const Vec3& high_m() const { return high_m_; }
  /// Within the box low_m .. high_m?
  bool is_near(const Vec3& p_m) const { return overlaps(p_m, p_m); }
  /// Is p on the inner side of the plane of the triangle that is nearest to it?
  bool is_behind(const Nearest& nearest, const Vec3& p_m) const;

  // Plain loops.
  Nearest nearest_by_loop(const Vec3& p_m) const;
  double winding_by_loop(const Vec3& p_m) const;
  bool crosses_by_loop(const Vec3& from_m, const Vec3& to_m) const;

  // By the grid. One thread at a time: what it has found it keeps.
  /// Infinite distance if nothing is within `within_m`.
  Nearest nearest(const Vec3& p_m, double within_m) const;
  double winding(const Vec3& p_m) const;
  bool crosses(const Vec3& from_m, const Vec3& to_m) const;

 private:
  using Triangle = std::array<Vec3, 3>;
  using Cell = std::array<int, 3>;

  void make_grid(double cell_m);
  void improve(Nearest& best, std::uint32_t t, const Vec3& p_m) const;
  void look_into(Nearest& best, const Cell& cell, const Vec3& p_m) const;
  bool overlaps(const Vec3& low_m, const Vec3& high_m) const;
  Cell cell_of(const Vec3& p_m) const;
  std::size_t index_of(const Cell& cell) const;
  Vec3 reference_m(const Cell& cell) const;
  double distance_to_cell_m(const Cell& cell, const Vec3& p_m) const;

  std::vector<Triangle> triangle_, cone_;
  Vec3 low_m_, high_m_;
  double cell_m_ = 0.0;
  Cell size_{};
  std::vector<std::vector<std::uint32_t>> cell_;
  mutable std::vector<std::int8_t> cell_winding_;  // of reference_m, with the cone
  mutable std::vector<std::uint64_t> stamp_;       // the query that has seen a triangle
  mutable std::uint64_t query_ = 0;
};

}  // namespace tact::tests
