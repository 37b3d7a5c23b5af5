// SPDX-License-Identifier: Apache-2.0
#include "tests/support/brute_force.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace tact::tests {
namespace {

using model::Vec3;
using Triangle = std::array<Vec3, 3>;
using Cell = std::array<int, 3>;

constexpr std::int8_t kUnknown = 127;
constexpr int kMaxCells = 96;  // along an axis

Vec3 least(const Vec3& a, const Vec3& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
Vec3 most(const Vec3& a, const Vec3& b) { return -least(-a, -b); }

Vec3 nearest_on_segment(const Vec3& a, const Vec3& b, const Vec3& p) {
  const double along = dot(p - a, b - a) / dot(b - a, b - a);
  return a + std::clamp(along, 0.0, 1.0) * (b - a);
}

Vec3 nearest_on_triangle(const Triangle& t, const Vec3& p) {
  const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
  bool is_above = true;
  for (std::size_t i = 0; i < 3; ++i)
    is_above = is_above && dot(cross(n, t[(i + 1) % 3] - t[i]), p - t[i]) >= 0.0;
  if (is_above) return p - dot(p - t[0], n) / dot(n, n) * n;
  Vec3 best = nearest_on_segment(t[0], t[1], p);
  for (std::size_t i = 1; i < 3; ++i) {
    const Vec3 q = nearest_on_segment(t[i], t[(i + 1) % 3], p);
    if (norm(q - p) < norm(best - p)) best = q;
  }
  return best;
}

// The half angles add up as the argument of a product of complex numbers: one atan2 for all.
double winding_of(std::span<const Triangle> triangles, const Vec3& p) {
  double re = 1.0, im = 0.0;
  int turns = 0;
  for (const Triangle& t : triangles) {
    const Vec3 a = t[0] - p, b = t[1] - p, c = t[2] - p;
    const double la = norm(a), lb = norm(b), lc = norm(c);
    const double x = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    const double y = dot(a, cross(b, c));
    const double next_re = re * x - im * y, next_im = re * y + im * x;
    if (im >= 0.0 && y >= 0.0 && next_im < 0.0) ++turns;
    if (im < 0.0 && y < 0.0 && next_im >= 0.0) --turns;
    const double size = std::abs(next_re) + std::abs(next_im);
    re = next_re / size;
    im = next_im / size;
  }
  return std::atan2(im, re) / (2.0 * std::numbers::pi) + turns;
}

/// +1: the segment enters through the triangle, -1: it leaves, 0: it misses.
int crossing(const Triangle& t, const Vec3& from, const Vec3& to) {
  const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
  const bool starts_below = dot(n, t[0] - from) > 0.0, ends_below = dot(n, t[0] - to) > 0.0;
  if (starts_below == ends_below) return 0;
  const Vec3 a = t[0] - from, b = t[1] - from, c = t[2] - from, way = to - from;
  const bool ab = dot(way, cross(a, b)) > 0.0, bc = dot(way, cross(b, c)) > 0.0,
             ca = dot(way, cross(c, a)) > 0.0;
  if (ab != bc || bc != ca) return 0;
  return ends_below ? 1 : -1;
}

/// Until one says no; did all say yes?
template <typename Visit>
bool for_cells(const Cell& low, const Cell& high, const Visit& visit) {
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x)
        if (!visit(Cell{x, y, z})) return false;
  return true;
}

}  // namespace

BruteForce::BruteForce(std::span<const Vec3> vertex_m, std::span<const Corners> triangle) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edge;
  double edges_m = 0.0;
  for (const Corners& c : triangle) {
    triangle_.push_back({vertex_m[c[0]], vertex_m[c[1]], vertex_m[c[2]]});
    for (std::size_t i = 0; i < 3; ++i) {
      edge.insert({c[i], c[(i + 1) % 3]});
      edges_m += norm(vertex_m[c[(i + 1) % 3]] - vertex_m[c[i]]);
    }
  }
  Vec3 apex_m;
  for (const auto& [a, b] : edge)
    if (!edge.contains({b, a})) {
      cone_.push_back({vertex_m[b], vertex_m[a], {}});
      apex_m += vertex_m[a];
    }
  for (Triangle& t : cone_) t[2] = apex_m / double(cone_.size());
  make_grid(1.5 * edges_m / (3.0 * double(triangle.size())));
}

void BruteForce::make_grid(double cell_m) {
  low_m_ = high_m_ = triangle_.front()[0];
  for (const Triangle& t : triangle_)
    for (const Vec3& v : t) low_m_ = least(low_m_, v), high_m_ = most(high_m_, v);
  const Vec3 span_m = high_m_ - low_m_;
  cell_m_ = std::max(cell_m, std::max({span_m.x, span_m.y, span_m.z}) / kMaxCells);
  size_ = {int(span_m.x / cell_m_) + 1, int(span_m.y / cell_m_) + 1, int(span_m.z / cell_m_) + 1};
  cell_.resize(std::size_t(size_[0]) * std::size_t(size_[1]) * std::size_t(size_[2]));
  cell_winding_.assign(cell_.size(), kUnknown);
  stamp_.assign(triangle_.size(), 0);
  constexpr Vec3 kMargin_m{1e-9, 1e-9, 1e-9};
  for (std::uint32_t k = 0; k < triangle_.size(); ++k) {
    const auto& [a, b, c] = triangle_[k];
    for_cells(cell_of(least(least(a, b), c) - kMargin_m), cell_of(most(most(a, b), c) + kMargin_m),
              [&](const Cell& cell) {
                cell_[index_of(cell)].push_back(k);
                return true;
              });
  }
}

bool BruteForce::is_behind(const Nearest& nearest, const Vec3& p_m) const {
  const auto& [a, b, c] = triangle_[nearest.triangle];
  return dot(cross(b - a, c - a), p_m - nearest.point_m) < 0.0;
}

BruteForce::Nearest BruteForce::nearest_by_loop(const Vec3& p_m) const {
  Nearest best;
  for (std::uint32_t t = 0; t < triangle_.size(); ++t) improve(best, t, p_m);
  return best;
}

double BruteForce::winding_by_loop(const Vec3& p_m) const { return winding_of(triangle_, p_m); }

bool BruteForce::crosses_by_loop(const Vec3& from_m, const Vec3& to_m) const {
  return std::any_of(triangle_.begin(), triangle_.end(),
                     [&](const Triangle& t) { return crossing(t, from_m, to_m) != 0; });
}

BruteForce::Nearest BruteForce::nearest(const Vec3& p_m, double within_m) const {
  Nearest best;
  best.distance_m = within_m;
  const Vec3 reach_m{within_m, within_m, within_m};
  if (overlaps(p_m - reach_m, p_m + reach_m)) {
    ++query_;
    look_into(best, cell_of(p_m), p_m);  // makes the others short
    for_cells(cell_of(p_m - reach_m), cell_of(p_m + reach_m), [&](const Cell& cell) {
      if (!cell_[index_of(cell)].empty() && distance_to_cell_m(cell, p_m) < best.distance_m)
        look_into(best, cell, p_m);
      return true;
    });
  }
  if (!(best.distance_m < within_m)) best.distance_m = std::numeric_limits<double>::infinity();
  return best;
}

double BruteForce::winding(const Vec3& p_m) const {
  const double cone = winding_of(cone_, p_m);
  if (!is_near(p_m)) return -cone;
  const Cell cell = cell_of(p_m);
  const std::size_t k = index_of(cell);
  const Vec3 from_m = reference_m(cell);
  if (cell_winding_[k] == kUnknown)
    cell_winding_[k] =
        std::int8_t(std::lround(winding_by_loop(from_m) + winding_of(cone_, from_m)));
  int w = cell_winding_[k];
  for (const std::uint32_t t : cell_[k]) w += crossing(triangle_[t], from_m, p_m);
  for (const Triangle& t : cone_) w += crossing(t, from_m, p_m);
  return w - cone;
}

bool BruteForce::crosses(const Vec3& from_m, const Vec3& to_m) const {
  const Vec3 a_m = least(from_m, to_m), b_m = most(from_m, to_m);
  if (!overlaps(a_m, b_m)) return false;
  const Cell low = cell_of(a_m), high = cell_of(b_m);
  constexpr int kMany = 1000;
  if ((high[0] - low[0] + 1) * (high[1] - low[1] + 1) * (high[2] - low[2] + 1) > kMany)
    return crosses_by_loop(from_m, to_m);
  return !for_cells(low, high, [&](const Cell& cell) {
    const std::vector<std::uint32_t>& here = cell_[index_of(cell)];
    return std::none_of(here.begin(), here.end(),
                        [&](std::uint32_t t) { return crossing(triangle_[t], from_m, to_m) != 0; });
  });
}

void BruteForce::improve(Nearest& best, std::uint32_t t, const Vec3& p_m) const {
  const Vec3 q_m = nearest_on_triangle(triangle_[t], p_m);
  const double distance_m = norm(q_m - p_m);
  if (distance_m < best.distance_m) best = {distance_m, q_m, t};
}

void BruteForce::look_into(Nearest& best, const Cell& cell, const Vec3& p_m) const {
  for (const std::uint32_t t : cell_[index_of(cell)])
    if (std::exchange(stamp_[t], query_) != query_) improve(best, t, p_m);
}

bool BruteForce::overlaps(const Vec3& low_m, const Vec3& high_m) const {
  return low_m.x <= high_m_.x && low_m.y <= high_m_.y && low_m.z <= high_m_.z &&
         high_m.x >= low_m_.x && high_m.y >= low_m_.y && high_m.z >= low_m_.z;
}

Cell BruteForce::cell_of(const Vec3& p_m) const {
  const Vec3 at = (p_m - low_m_) / cell_m_;
  return {int(std::clamp(at.x, 0.0, size_[0] - 1.0)), int(std::clamp(at.y, 0.0, size_[1] - 1.0)),
          int(std::clamp(at.z, 0.0, size_[2] - 1.0))};
}

std::size_t BruteForce::index_of(const Cell& cell) const {
  return (std::size_t(cell[2]) * std::size_t(size_[1]) + std::size_t(cell[1])) *
             std::size_t(size_[0]) +
         std::size_t(cell[0]);
}

// A point of the cell, off the planes and edges of a mesh with round coordinates.
Vec3 BruteForce::reference_m(const Cell& cell) const {
  return low_m_ + cell_m_ * Vec3{cell[0] + 0.48971, cell[1] + 0.51313, cell[2] + 0.50717};
}

double BruteForce::distance_to_cell_m(const Cell& cell, const Vec3& p_m) const {
  const Vec3 at = (p_m - low_m_) / cell_m_;
  const auto beyond = [](double x, int k) { return std::max(std::max(k - x, x - (k + 1)), 0.0); };
  return cell_m_ * norm(Vec3{beyond(at.x, cell[0]), beyond(at.y, cell[1]), beyond(at.z, cell[2])});
}

}  // namespace tact::tests
