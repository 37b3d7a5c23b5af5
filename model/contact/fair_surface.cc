// SPDX-License-Identifier: Apache-2.0
#include "model/contact/fair_surface.h"

#include <algorithm>
#include <cmath>

#include "model/mat3.h"

namespace tact::model::contact {
namespace {

// The mean over a triangle of SF-1's height, sum b_i ((p_i - q) . n_i) / 2; b_i b_j has the mean
// 1/12.
double mean_height_m(const SurfaceView& mesh, const TriangleCorners& t) {
  double height_m = 0.0;
  for (const std::uint32_t i : t)
    for (const std::uint32_t j : t)
      height_m += dot(mesh.vertex_m[i] - mesh.vertex_m[j], mesh.vertex_normal[i]) / 24.0;
  return height_m;
}

// Of each vertex, over the area of its triangles.
std::vector<double> mean_heights_m(const SurfaceView& mesh) {
  std::vector<double> sum(mesh.vertex_m.size()), area(mesh.vertex_m.size());
  for (const TriangleCorners& t : mesh.triangle) {
    const double height_m = mean_height_m(mesh, t);
    const Vec3& p_m = mesh.vertex_m[t[0]];
    const double area_m2 = norm(cross(mesh.vertex_m[t[1]] - p_m, mesh.vertex_m[t[2]] - p_m));
    for (const std::uint32_t v : t) sum[v] += area_m2 * height_m, area[v] += area_m2;
  }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] = area[v] > 0.0 ? sum[v] / area[v] : 0.0;
  return sum;
}

struct Corner {
  Vec3 point_m, normal;
};

// What no sweep changes at a corner.
struct CornerFit {
  std::array<Vec3, 2> axis;
  double edge_m = 0.0;  // mean of the mesh
  std::vector<std::uint32_t> near;
};

CornerFit corner_fit(const SurfaceView& mesh, std::uint32_t v) {
  CornerFit fit{axes_across(mesh.vertex_normal[v]), 0.0, neighbours_of(mesh, v)};
  for (const std::uint32_t w : fit.near) fit.edge_m += norm(mesh.vertex_m[w] - mesh.vertex_m[v]);
  if (!fit.near.empty()) fit.edge_m /= static_cast<double>(fit.near.size());
  return fit;
}

// One Gauss-Newton step on one corner alone: its normal along two axes, its height over the mean
// edge.
void fit_corner(const CornerFit& fit, const FairParameters& p, const Corner& first,
                std::span<const Corner> all, Corner& corner) {
  const auto [e1, e2] = fit.axis;
  const double turn = p.turn_weight_ratio, height = p.height_weight_ratio;
  const Vec3 turned = corner.normal - first.normal, moved_m = corner.point_m - first.point_m;
  Mat3 a{{Vec3{turn, 0, 0}, Vec3{0, turn, 0}, Vec3{0, 0, height}}};
  Vec3 b{-turn * dot(turned, e1), -turn * dot(turned, e2),
         -height * dot(moved_m, first.normal) / fit.edge_m};
  for (const std::uint32_t w : fit.near) {
    const Vec3 way_m = all[w].point_m - corner.point_m;
    const double length_m = norm(way_m);
    const Vec3 both = corner.normal + all[w].normal;
    const double residual = dot(both, way_m) / length_m;
    const Vec3 d{dot(e1, way_m) / length_m, dot(e2, way_m) / length_m,
                 -fit.edge_m * dot(both, first.normal) / length_m};
    a = a + Mat3{{d.x * d, d.y * d, d.z * d}};
    b -= residual * d;
  }
  const Vec3 step = inverse(a) * b;
  corner.normal = normalized(corner.normal + step.x * e1 + step.y * e2);
  corner.point_m += (step.z * fit.edge_m) * first.normal;
}

}  // namespace

std::vector<std::uint32_t> neighbours_of(const SurfaceView& mesh, std::uint32_t v) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t k = mesh.fan_start[v]; k < mesh.fan_start[v + 1]; ++k)
    for (const std::uint32_t w : mesh.triangle[mesh.fan[k]])
      if (w != v && std::ranges::find(out, w) == out.end()) out.push_back(w);
  return out;
}

std::array<Vec3, 2> axes_across(const Vec3& normal) {
  const Vec3 other = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 axis = normalized(cross(normal, other));
  return {axis, cross(normal, axis)};
}

std::vector<SurfaceCorner> fair_corners(const SurfaceView& mesh, const FairParameters& p) {
  const std::size_t count = mesh.vertex_m.size();
  const std::vector<double> height_m = mean_heights_m(mesh);
  std::vector<Corner> now(count);
  std::vector<CornerFit> fit(count);
  for (std::uint32_t v = 0; v < count; ++v) {
    const Vec3& n = mesh.vertex_normal[v];
    now[v] = {mesh.vertex_m[v] - height_m[v] * n, n};
    fit[v] = corner_fit(mesh, v);
  }
  const std::vector<Corner> first = now;
  for (int sweep = 0; sweep < p.sweeps; ++sweep)
    for (std::uint32_t v = 0; v < count; ++v)
      if (!fit[v].near.empty()) fit_corner(fit[v], p, first[v], now, now[v]);
  std::vector<SurfaceCorner> out(count);
  for (std::size_t v = 0; v < count; ++v)
    out[v] = {narrowed(now[v].point_m), narrowed(now[v].normal)};
  return out;
}

}  // namespace tact::model::contact
