// SPDX-License-Identifier: Apache-2.0
#include "model/tissue/vertex_compliance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "model/contact/fair_surface.h"
#include "model/contact/tangent.h"

namespace tact::model::tissue {
namespace {

using contact::SurfaceCorner;
using contact::SurfaceView;
using contact::VertexCompliance;
using Six = std::array<double, 6>;  // xx yy zz yz zx xy

// r n n' + n1 (n a' + a n') + n2 (n b' + b n') + s1 a a' + s2 b b', times E; a, b the map's axes.
Six tensor_of(const ComplianceMap& map, const Vec3& n, std::size_t v,
              const VertexComplianceParameters& p) {
  const SidewaysCompliance& g = map.sideways_times_E_per_m[v];
  const Vec3 axis{static_cast<double>(g.axis[0]), static_cast<double>(g.axis[1]),
                  static_cast<double>(g.axis[2])};
  const Vec3 a = normalized(tangential(axis, n)), b = cross(n, a);
  const double r =
      std::max(static_cast<double>(map.regular_times_E_per_m[v]), p.min_normal_times_E_per_m);
  const double s1 = std::max(static_cast<double>(g.s1), p.min_sideways_times_E_per_m);
  const double s2 = std::max(static_cast<double>(g.s2), p.min_sideways_times_E_per_m);
  const auto n1 = static_cast<double>(g.n1), n2 = static_cast<double>(g.n2);
  const Vec3 of_n = r * n + n1 * a + n2 * b, of_a = n1 * n + s1 * a, of_b = n2 * n + s2 * b;
  const auto column = [&](double x, double y, double z) { return x * of_n + y * of_a + z * of_b; };
  const Vec3 x = column(n.x, a.x, b.x), y = column(n.y, a.y, b.y), z = column(n.z, a.z, b.z);
  return {x.x, y.y, z.z, z.y, z.x, y.x};
}

// v and the vertices of two rings around it.
std::vector<std::uint32_t> two_rings(const SurfaceView& mesh, std::uint32_t v) {
  std::vector<std::uint32_t> out{v};
  std::size_t next = 0;
  for (int ring = 0; ring < 2; ++ring)
    for (const std::size_t end = out.size(); next < end; ++next)
      for (const std::uint32_t w : contact::neighbours_of(mesh, out[next]))
        if (std::ranges::find(out, w) == out.end()) out.push_back(w);
  return out;
}

// While it is fitted, times E: the tensor, and the slope of each of its components by axis.
struct Field {
  Six value{};
  std::array<Six, 3> slope{};
};

// Weighted moments of the plane a + b x + c y through the values around a vertex.
struct PlaneMoments {
  double m = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  Six g{}, gx{}, gy{};

  void add(double weight, double at_x, double at_y, const Six& value) {
    m += weight, x += weight * at_x, y += weight * at_y;
    xx += weight * at_x * at_x, xy += weight * at_x * at_y, yy += weight * at_y * at_y;
    for (std::size_t k = 0; k < 6; ++k) {
      g[k] += weight * value[k];
      gx[k] += weight * at_x * value[k];
      gy[k] += weight * at_y * value[k];
    }
  }
  /// b, c of the k-th value; 0 where the vertices lie on a line.
  contact::Vec2 slope(std::size_t k) const {
    const double cxx = xx - x * x / m, cyy = yy - y * y / m, cxy = xy - x * y / m;
    const double det = cxx * cyy - cxy * cxy;
    if (!(det > 0.0)) return {};
    const double rx = gx[k] - x * g[k] / m, ry = gy[k] - y * g[k] / m;
    return {(cyy * rx - cxy * ry) / det, (cxx * ry - cxy * rx) / det};
  }
};

// Value of the map, slope of the plane.
Field first_guess(const std::vector<Six>& tensor, const SurfaceView& mesh, std::uint32_t v,
                  double reach_m) {
  constexpr double kMinFacing = 0.1;
  const Vec3& n = mesh.vertex_normal[v];
  const auto [e1, e2] = contact::axes_across(n);
  PlaneMoments moments;
  for (const std::uint32_t w : two_rings(mesh, v)) {
    if (!(dot(mesh.vertex_normal[w], n) > kMinFacing)) continue;
    const Vec3 away_m = mesh.vertex_m[w] - mesh.vertex_m[v];
    const double weight = std::exp(-0.5 * dot(away_m, away_m) / (reach_m * reach_m));
    moments.add(weight, dot(away_m, e1), dot(away_m, e2), tensor[w]);
  }
  Field out{.value = tensor[v], .slope = {}};
  for (std::size_t k = 0; k < 6; ++k) {
    const contact::Vec2 along = moments.slope(k);
    const Vec3 slope = along.x * e1 + along.y * e2;
    out.slope[0][k] = slope.x, out.slope[1][k] = slope.y, out.slope[2][k] = slope.z;
  }
  return out;
}

// The part of the least-squares step that no sweep changes.
struct EdgeFit {
  std::uint32_t to = 0;
  double length_m = 0.0;
  Vec3 way_m,
      derivative;  // of the residual by slope along two axes and by value over the mean edge
};
struct VertexFit {
  std::array<Vec3, 2> axis;
  double edge_m = 0.0;  // mean
  Mat3 inverted;
  std::vector<EdgeFit> edge;
};

VertexFit vertex_fit(const SurfaceView& mesh, std::span<const SurfaceCorner> corner,
                     const VertexComplianceParameters& p, std::uint32_t v) {
  VertexFit fit{
      .axis = contact::axes_across(corner[v].normal()), .edge_m = 0.0, .inverted = {}, .edge = {}};
  for (const std::uint32_t w : contact::neighbours_of(mesh, v)) {
    const Vec3 way_m = corner[w].point_m() - corner[v].point_m();
    fit.edge.push_back({.to = w, .length_m = norm(way_m), .way_m = way_m, .derivative = {}});
    fit.edge_m += fit.edge.back().length_m;
  }
  if (fit.edge.empty()) return fit;
  fit.edge_m /= static_cast<double>(fit.edge.size());
  const auto [e1, e2] = fit.axis;
  Mat3 a{{Vec3{p.slope_weight_ratio, 0, 0}, Vec3{0, p.slope_weight_ratio, 0},
          Vec3{0, 0, p.value_weight_ratio}}};
  for (EdgeFit& edge : fit.edge) {
    const Vec3 d{0.5 * dot(e1, edge.way_m) / edge.length_m,
                 0.5 * dot(e2, edge.way_m) / edge.length_m, fit.edge_m / edge.length_m};
    a = a + Mat3{{d.x * d, d.y * d, d.z * d}};
    edge.derivative = d;
  }
  fit.inverted = inverse(a);
  return fit;
}

// One least-squares step on one vertex alone: slope along two axes, value over the mean edge.
void fit_vertex(const VertexFit& fit, const VertexComplianceParameters& p, const Field& first,
                std::span<const Field> all, Field& now) {
  const auto [e1, e2] = fit.axis;
  Six b1, b2, b3;
  for (std::size_t k = 0; k < 6; ++k) {
    const Vec3 change{now.slope[0][k] - first.slope[0][k], now.slope[1][k] - first.slope[1][k],
                      now.slope[2][k] - first.slope[2][k]};
    b1[k] = -p.slope_weight_ratio * dot(change, e1);
    b2[k] = -p.slope_weight_ratio * dot(change, e2);
    b3[k] = -p.value_weight_ratio * (now.value[k] - first.value[k]) / fit.edge_m;
  }
  for (const EdgeFit& edge : fit.edge) {
    const Field& other = all[edge.to];
    const Vec3 half_way = (0.5 / edge.length_m) * edge.way_m, d = edge.derivative;
    const double per_m = 1.0 / edge.length_m;
    for (std::size_t k = 0; k < 6; ++k) {
      const double residual = per_m * (now.value[k] - other.value[k]) +
                              half_way.x * (now.slope[0][k] + other.slope[0][k]) +
                              half_way.y * (now.slope[1][k] + other.slope[1][k]) +
                              half_way.z * (now.slope[2][k] + other.slope[2][k]);
      b1[k] -= residual * d.x, b2[k] -= residual * d.y, b3[k] -= residual * d.z;
    }
  }
  for (std::size_t k = 0; k < 6; ++k) {
    const Vec3 step = fit.inverted * Vec3{b1[k], b2[k], b3[k]};
    const Vec3 slope = step.x * e1 + step.y * e2;
    now.slope[0][k] += slope.x, now.slope[1][k] += slope.y, now.slope[2][k] += slope.z;
    now.value[k] += step.z * fit.edge_m;
  }
}

VertexCompliance packed(const Field& field) {
  constexpr double kMaxSteps = 32767.0;
  double largest = 0.0;
  for (const Six& axis : field.slope)
    for (const double slope : axis) largest = std::max(largest, std::abs(slope));
  VertexCompliance out;
  out.slope_step_times_E_per_m2 = static_cast<float>(largest / kMaxSteps);
  for (std::size_t k = 0; k < 6; ++k) {
    out.times_E_per_m[k] = static_cast<float>(field.value[k]);
    for (std::size_t axis = 0; axis < 3 && largest > 0.0; ++axis)
      out.slope_steps[k][axis] =
          static_cast<std::int16_t>(std::lround(field.slope[axis][k] / largest * kMaxSteps));
  }
  return out;
}

}  // namespace

std::vector<VertexCompliance> vertex_compliance(const ComplianceMap& map, const SurfaceView& mesh,
                                                std::span<const SurfaceCorner> corner,
                                                const VertexComplianceParameters& p) {
  const std::size_t count = map.vertices();
  std::vector<Six> tensor(count);
  for (std::size_t v = 0; v < count; ++v) tensor[v] = tensor_of(map, mesh.vertex_normal[v], v, p);
  std::vector<Field> now(count);
  std::vector<VertexFit> fit(count);
  for (std::uint32_t v = 0; v < count; ++v) {
    now[v] = first_guess(tensor, mesh, v, p.reach_m);
    fit[v] = vertex_fit(mesh, corner, p, v);
  }
  const std::vector<Field> first = now;
  for (int sweep = 0; sweep < p.sweeps; ++sweep)
    for (std::uint32_t v = 0; v < count; ++v)
      if (!fit[v].edge.empty()) fit_vertex(fit[v], p, first[v], now, now[v]);
  std::vector<VertexCompliance> out(count);
  std::ranges::transform(now, out.begin(), packed);
  return out;
}

}  // namespace tact::model::tissue
