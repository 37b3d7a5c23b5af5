// SPDX-License-Identifier: Apache-2.0
#include "model/contact/contact_point.h"

#include "model/contact/nearest.h"

namespace tact::model::contact {
namespace {

using Weights = std::array<double, 3>;  // of the corners, sum 1

struct Spot {
  Vec3 point_m;
  Weights weight{};
};

/// The point with its squared distance to p: comparisons need no root.
Nearest at(const Spot& x, const Vec3& p, std::uint32_t t, Feature f, std::uint32_t i) RT_SAFE {
  return {x.point_m, dot(p - x.point_m, p - x.point_m), {t, x.weight}, f, i};
}

void try_triangle(const SurfaceView& s, std::uint32_t t, const Vec3& p, Nearest& best) RT_SAFE {
  if (t == kNoTriangle) return;
  const Nearest other = nearest_on(s, t, p);
  // Strictly nearer, so that the search cannot cycle.
  if (other.squared_m2 < best.squared_m2) best = other;
}

// The nearest of the neighbours across the edge or corner with the nearest point. For p inside the
// body a neighbour may be nearer although the nearest point is on the face: all edges are tried.
Nearest step_from(const SurfaceView& s, const Nearest& here, const Vec3& p) RT_SAFE {
  Nearest best = here;
  const TriangleRecord& record = s.record[here.surface_point.triangle];
  switch (here.feature) {
    case Feature::kFace:
      if (dot(p - here.point_m, record.normal) < 0.0)
        // bound: 3 (edges)
        for (const std::uint32_t t : record.neighbour) try_triangle(s, t, p, best);
      break;
    case Feature::kEdge:
      try_triangle(s, record.neighbour[here.index], p, best);
      break;
    case Feature::kCorner: {
      const auto fan = s.fan.subspan(record.fan_start[here.index], record.fan_count[here.index]);
      // bound: fan (largest of the mesh)
      for (const std::uint32_t t : fan) try_triangle(s, t, p, best);
      break;
    }
  }
  return best;
}

// A point whose nearest point is on the boundary of an open surface counts as outside.
bool is_on_boundary(const SurfaceView& s, const Nearest& at) RT_SAFE {
  const TriangleRecord& record = s.record[at.surface_point.triangle];
  if (at.feature == Feature::kEdge) return record.neighbour[at.index] == kNoTriangle;
  return at.feature == Feature::kCorner && record.on_boundary[at.index];
}

// The normal that gives the right sign: of the face, of both faces of an edge, of all faces around
// a corner [Baerentzen, Aanaes 2005].
Vec3 pseudo_normal(const SurfaceView& s, const Nearest& at) RT_SAFE {
  const TriangleRecord& record = s.record[at.surface_point.triangle];
  switch (at.feature) {
    case Feature::kCorner:
      return s.vertex_normal[s.triangle[at.surface_point.triangle][at.index]];
    case Feature::kEdge: {
      const std::uint32_t other = record.neighbour[at.index];
      if (other != kNoTriangle) return normalized(record.normal + s.record[other].normal);
      break;
    }
    case Feature::kFace:
      break;
  }
  return record.normal;
}

// Sets phi and n for p.
ContactPoint facing(ContactPoint contact_point, const Vec3& p_m, bool is_outside) RT_SAFE {
  const Vec3 away = p_m - contact_point.point_m;
  const double length_m = norm(away);
  // At edges and corners a face normal could give the wrong sign.
  const double sign = is_outside || dot(away, contact_point.outward) >= 0.0 ? 1.0 : -1.0;
  constexpr double kOnSurface_m = 1e-9;  // below this the direction of p - x is rounding noise
  contact_point.normal = length_m > kOnSurface_m ? (sign / length_m) * away : contact_point.outward;
  contact_point.distance_m = sign * length_m;
  return contact_point;
}

}  // namespace

// Voronoi regions of a triangle [C. Ericson, Real-Time Collision Detection (2005) 5.1.5].
Nearest nearest_on(const SurfaceView& s, std::uint32_t t, const Vec3& p) RT_SAFE {
  const auto& [a, b, c] = s.record[t].corner_m;
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  // Zero weights are exactly 0, which marks edges and corners (SurfacePoint).
  if (d1 <= 0.0 && d2 <= 0.0) return at({a, {1, 0, 0}}, p, t, Feature::kCorner, 0);
  const Vec3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return at({b, {0, 1, 0}}, p, t, Feature::kCorner, 1);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double w = d1 / (d1 - d3);
    return at({a + w * ab, {1.0 - w, w, 0}}, p, t, Feature::kEdge, 0);
  }
  const Vec3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return at({c, {0, 0, 1}}, p, t, Feature::kCorner, 2);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double w = d2 / (d2 - d6);
    return at({a + w * ac, {1.0 - w, 0, w}}, p, t, Feature::kEdge, 2);
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return at({b + w * (c - b), {0, 1.0 - w, w}}, p, t, Feature::kEdge, 1);
  }
  const double sum = va + vb + vc, v = vb / sum, w = vc / sum;
  return at({a + v * ab + w * ac, {1.0 - v - w, v, w}}, p, t, Feature::kFace, 0);
}

ContactPoint contact_point_of(const SurfaceView& surface, const Nearest& nearest,
                              const Vec3& p_m) RT_SAFE {
  return facing({.surface_point = nearest.surface_point,
                 .point_m = nearest.point_m,
                 .normal = {},
                 .outward = pseudo_normal(surface, nearest),
                 .distance_m = 0.0},
                p_m, is_on_boundary(surface, nearest));
}

ContactPoint follow(const SurfaceView& surface, std::uint32_t start, const Vec3& p_m) RT_SAFE {
  Nearest here = nearest_on(surface, start, p_m);
  for (int i = 0; i < kMaxWalkSteps; ++i) {  // bound: kMaxWalkSteps
    const Nearest next = step_from(surface, here, p_m);
    if (next.surface_point.triangle == here.surface_point.triangle) break;
    here = next;
  }
  return contact_point_of(surface, here, p_m);
}

}  // namespace tact::model::contact
