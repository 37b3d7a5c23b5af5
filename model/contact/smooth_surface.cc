// SPDX-License-Identifier: Apache-2.0
#include "model/contact/smooth_surface.h"

#include <algorithm>
#include <cmath>

namespace tact::model::contact {
namespace {

// Gradients of the three weights over a flat triangle, 1/m.
std::array<Vec3, 3> weight_gradients(const TriangleRecord& record) RT_SAFE {
  const auto& [p0, p1, p2] = record.corner_m;
  const double twice_area_m2 = dot(cross(p1 - p0, p2 - p0), record.normal);
  return {cross(record.normal, p2 - p1) / twice_area_m2,
          cross(record.normal, p0 - p2) / twice_area_m2,
          cross(record.normal, p1 - p0) / twice_area_m2};
}

struct Map2 {
  double xx, xy, yx, yy;
  double determinant() const RT_SAFE { return xx * yy - xy * yx; }
};

// Displacement of x + h n along the axes for a unit displacement of x.
Map2 offset_map(const SurfaceFrame& f, double height_m) RT_SAFE {
  const Vec3 a = f.point_m_per_m[0] + height_m * f.normal_per_m[0];
  const Vec3 b = f.point_m_per_m[1] + height_m * f.normal_per_m[1];
  return {dot(f.axis[0], a), dot(f.axis[0], b), dot(f.axis[1], a), dot(f.axis[1], b)};
}

// Beyond a centre of curvature the map is not invertible: the height is halved, finally 0.
Map2 invertible_offset_map(const SurfaceFrame& f, double height_m) RT_SAFE {
  constexpr double kMinDeterminant = 0.15;
  constexpr int kHalvings = 4;
  Map2 m = offset_map(f, height_m);
  for (int i = 0;  // bound: kHalvings
       i < kHalvings && !(m.determinant() > kMinDeterminant && m.xx + m.yy > 2.0 * kMinDeterminant);
       ++i) {
    height_m *= 0.5;
    m = offset_map(f, i + 1 == kHalvings ? 0.0 : height_m);
  }
  return m;
}

// The same surface point in the neighbour across edge `edge`.
SurfacePoint across(const SurfaceView& mesh, const SurfacePoint& surface_point, std::size_t edge,
                    std::uint32_t next) RT_SAFE {
  const std::size_t end = (edge + 1) % 3;
  const TriangleCorners& from = mesh.triangle[surface_point.triangle];
  SurfacePoint out{.triangle = next, .weight = {}};
  for (std::size_t k = 0; k < 3; ++k) {
    if (mesh.triangle[next][k] == from[edge]) out.weight[k] = surface_point.weight[edge];
    if (mesh.triangle[next][k] == from[end]) out.weight[k] = surface_point.weight[end];
  }
  return out;
}

// A vector in the plane of one triangle, rotated about an edge into the plane of the next.
Vec3 unfolded(const TriangleRecord& from, std::size_t edge, const TriangleRecord& to,
              const Vec3& way_m) RT_SAFE {
  const Vec3 along = normalized(from.corner_m[(edge + 1) % 3] - from.corner_m[edge]);
  const double along_m = dot(way_m, along);
  return along_m * along + norm(way_m - along_m * along) * cross(along, to.normal);
}

}  // namespace

void fill_geometry(const SmoothSurface& surface, SurfaceFrame& f) RT_SAFE {
  const TriangleRecord& record = surface.mesh.record[f.surface_point.triangle];
  const TriangleCorners& corner = surface.mesh.triangle[f.surface_point.triangle];
  const std::array<double, 3>& b = f.surface_point.weight;
  f.axis[0] = normalized(record.corner_m[1] - record.corner_m[0]);
  f.axis[1] = cross(record.normal, f.axis[0]);
  const std::array<Vec3, 3> gradient_per_m = weight_gradients(record);
  std::array<Vec3, 3> db_per_m;  // x, y: along each axis
  std::array<Vec3, 3> point_m, normal;
  Vec3 q_m, sum;
  std::array<Vec3, 2> dq, dsum_per_m;
  for (std::size_t i = 0; i < 3; ++i) {
    const SurfaceCorner& c = surface.corner[corner[i]];
    const double db_0 = dot(gradient_per_m[i], f.axis[0]), db_1 = dot(gradient_per_m[i], f.axis[1]);
    db_per_m[i] = {db_0, db_1, 0.0};
    point_m[i] = c.point_m(), normal[i] = c.normal();
    q_m += b[i] * point_m[i], dq[0] += db_0 * point_m[i], dq[1] += db_1 * point_m[i];
    sum += b[i] * normal[i], dsum_per_m[0] += db_0 * normal[i], dsum_per_m[1] += db_1 * normal[i];
  }
  f.point_m = q_m, f.point_m_per_m = dq;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& n = normal[i];
    const double lift_m = 0.5 * dot(point_m[i] - q_m, n);
    f.point_m += (b[i] * lift_m) * n;
    f.point_m_per_m[0] += (db_per_m[i].x * lift_m - 0.5 * b[i] * dot(n, dq[0])) * n;
    f.point_m_per_m[1] += (db_per_m[i].y * lift_m - 0.5 * b[i] * dot(n, dq[1])) * n;
  }
  const double length = norm(sum);
  f.normal = sum / length;
  for (std::size_t k = 0; k < 2; ++k)
    f.normal_per_m[k] = tangential(dsum_per_m[k], f.normal) / length;
}

void fill_compliance(const SmoothSurface& surface, SurfaceFrame& f) RT_SAFE {
  f.compliance_m_per_N = f.slope_per_N = {};
  if (surface.compliance.empty()) return;
  const TriangleCorners& corner = surface.mesh.triangle[f.surface_point.triangle];
  std::array<double, 6> g{};
  std::array<Vec3, 6> dg{};
  for (std::size_t i = 0; i < 3; ++i) {  // bound: 3
    const VertexCompliance& v = surface.compliance[corner[i]];
    const Vec3 half_way_m = 0.5 * (f.point_m - surface.corner[corner[i]].point_m());
    const double weight = f.surface_point.weight[i] / surface.youngs_modulus_Pa;
    for (std::size_t k = 0; k < 6; ++k) {  // bound: 6
      const Vec3 slope = v.slope_times_E_per_m2(k);
      g[k] += weight * (static_cast<double>(v.times_E_per_m[k]) + dot(half_way_m, slope));
      dg[k] += weight * slope;
    }
  }
  f.compliance_m_per_N = {{Vec3{g[0], g[5], g[4]}, Vec3{g[5], g[1], g[3]}, Vec3{g[4], g[3], g[2]}}};
  // T e_j = -(1 - n n') grad(n' G e_j) / 2, column by column.
  const Vec3& n = f.normal;
  const Vec3 x = tangential(-0.5 * (n.x * dg[0] + n.y * dg[5] + n.z * dg[4]), n);
  const Vec3 y = tangential(-0.5 * (n.x * dg[5] + n.y * dg[1] + n.z * dg[3]), n);
  const Vec3 z = tangential(-0.5 * (n.x * dg[4] + n.y * dg[3] + n.z * dg[2]), n);
  f.slope_per_N = transpose({{x, y, z}});
}

LocalPosition local_position(const SurfaceFrame& f, const Vec3& point_m) RT_SAFE {
  const Vec3 away_m = point_m - f.point_m;
  const double height_m = dot(away_m, f.normal);
  return {height_m, away_m - height_m * f.normal};
}

// The smaller eigenvalue of the symmetric part of the map.
double offset_ratio(const SurfaceFrame& f, double height_m) RT_SAFE {
  const Map2 m = offset_map(f, height_m);
  return 0.5 * (m.xx + m.yy) - std::hypot(0.5 * (m.xx - m.yy), 0.5 * (m.xy + m.yx));
}

Vec3 way_to_foot(const SurfaceFrame& f, double height_m, const Vec3& tangential_m) RT_SAFE {
  const Map2 m = invertible_offset_map(f, height_m);
  const double x_m = dot(f.axis[0], tangential_m), y_m = dot(f.axis[1], tangential_m);
  const double d = m.determinant();
  return ((m.yy * x_m - m.xy * y_m) / d) * f.axis[0] + ((m.xx * y_m - m.yx * x_m) / d) * f.axis[1];
}

Mat3 normal_slope_per_m(const SurfaceFrame& f, double height_m) RT_SAFE {
  const Map2 m = invertible_offset_map(f, height_m);
  const double d = m.determinant();
  const Vec3 row_0 = (m.yy / d) * f.axis[0] - (m.xy / d) * f.axis[1];
  const Vec3 row_1 = (m.xx / d) * f.axis[1] - (m.yx / d) * f.axis[0];
  const Vec3 &a = f.normal_per_m[0], &b = f.normal_per_m[1];
  return {{a.x * row_0 + b.x * row_1, a.y * row_0 + b.y * row_1, a.z * row_0 + b.z * row_1}};
}

void move_along(const SurfaceView& mesh, SurfacePoint& surface_point, Vec3 way_m) RT_SAFE {
  constexpr int kMaxEdges = 8;
  for (int i = 0; i < kMaxEdges; ++i) {  // bound: kMaxEdges (triangles)
    const TriangleRecord& record = mesh.record[surface_point.triangle];
    const std::array<Vec3, 3> gradient_per_m = weight_gradients(record);
    std::array<double, 3> db{};
    double share = 1.0;
    std::size_t first = 3;  // the corner whose weight ends first
    for (std::size_t k = 0; k < 3; ++k) {
      db[k] = dot(gradient_per_m[k], way_m);
      if (db[k] < 0.0 && surface_point.weight[k] + share * db[k] < 0.0)
        share = std::max(-surface_point.weight[k] / db[k], 0.0), first = k;
    }
    for (std::size_t k = 0; k < 3; ++k) surface_point.weight[k] += share * db[k];
    if (first == 3) {
      const double sum =
          surface_point.weight[0] + surface_point.weight[1] + surface_point.weight[2];
      for (double& weight : surface_point.weight) weight /= sum;
      return;
    }
    surface_point.weight[first] = 0.0;
    const std::size_t edge = (first + 1) % 3;
    const std::uint32_t next = record.neighbour[edge];
    if (next == kNoTriangle) return;
    way_m = unfolded(record, edge, mesh.record[next], (1.0 - share) * way_m);
    surface_point = across(mesh, surface_point, edge, next);
  }
}

}  // namespace tact::model::contact
