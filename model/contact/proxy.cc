// SPDX-License-Identifier: Apache-2.0
#include "model/contact/proxy.h"

#include <algorithm>

namespace tact::model::contact {
namespace {

constexpr double kRounding_m = 1e-9;  // difference of one point computed from two triangles

}  // namespace

void Proxy::restart(const ContactPoint& contact_point, double radius_m) RT_SAFE {
  contact_point_ = contact_point;
  outward_ = contact_point.normal;
  offset_m_ = contact_point.point_m + radius_m * outward_;
  lags_ = false;
  lengthened_m_ = 0.0;
}

void Proxy::follow(const SurfaceView& surface, const Vec3& centre_m, const Vec3& moved_m,
                   double radius_m) RT_SAFE {
  const double before_m = radius_m - contact_point_.distance_m;
  const Vec3 normal_before = contact_point_.normal;
  const bool lagged = lags_;
  move_to(surface, centre_m, norm(tangential(moved_m, normal_before)), radius_m);
  // Without lag the depth is a function of c alone. With lag the explained part is that of the
  // work, by the trapezium rule with both normals.
  const double led_m = -0.5 * dot(normal_before + contact_point_.normal, moved_m);
  lengthened_m_ = lagged || lags_ ? radius_m - contact_point_.distance_m - before_m - led_m : 0.0;
}

void Proxy::move_to(const SurfaceView& surface, const Vec3& centre_m, double across_m,
                    double radius_m) RT_SAFE {
  const ContactPoint nearest =
      contact::follow(surface, contact_point_.surface_point.triangle, centre_m);
  const Vec3 goal_m = nearest.point_m + radius_m * nearest.normal;
  const double most_m = kSlide_ratio * across_m;
  if (norm(goal_m - offset_m_) <= most_m + kRounding_m) return restart(nearest, radius_m);
  slide(surface, goal_m, most_m, radius_m);
  const ContactPoint from_here =
      contact::follow(surface, contact_point_.surface_point.triangle, centre_m);
  const Vec3 line_m = outward_of(from_here, depth_m(centre_m), radius_m);
  const double length_m = norm(line_m);
  contact_point_.distance_m = radius_m - length_m;
  contact_point_.normal = length_m > 0.0 ? line_m / length_m : outward_;
  lags_ = true;
}

// The line from c to g without a component into the organ.
Vec3 Proxy::depth_m(const Vec3& centre_m) const RT_SAFE {
  const Vec3 line_m = offset_m_ - centre_m;
  return tangential(line_m, outward_) + std::max(dot(line_m, outward_), 0.0) * outward_;
}

// Removes the component towards the nearest point for a sphere outside of the organ, if g is near
// that point: g may be on the other side of an edge.
Vec3 Proxy::outward_of(const ContactPoint& nearest, const Vec3& line_m,
                       double radius_m) const RT_SAFE {
  const double inward_m = std::min(dot(line_m, nearest.normal), 0.0);
  // Not beyond the boundary of an open surface, nor behind it.
  const bool is_in_front = nearest.distance_m > 0.0 && dot(nearest.normal, nearest.outward) > 0.0;
  if (!is_in_front || !(inward_m < 0.0)) return line_m;
  // Completely within a tenth of the radius from that point, not at all beyond one radius.
  const double apart_ratio = norm(nearest.point_m - contact_point_.point_m) / radius_m;
  return line_m - std::clamp((1.0 - apart_ratio) / 0.9, 0.0, 1.0) * inward_m * nearest.normal;
}

// Slides g along the offset surface. In a crease g does not move if a step would make it jump.
void Proxy::slide(const SurfaceView& surface, const Vec3& goal_m, double way_m,
                  double radius_m) RT_SAFE {
  constexpr double kThrown_ratio = 1.5;  // of the step
  const Vec3 along_m = tangential(goal_m - offset_m_, outward_);
  const double length_m = norm(along_m);
  if (!(length_m > 0.0)) return;
  const Vec3 moved_m = offset_m_ + (std::min(way_m, length_m) / length_m) * along_m;
  const ContactPoint contact_point =
      contact::follow(surface, contact_point_.surface_point.triangle, moved_m);
  const Vec3 offset_m = contact_point.point_m + radius_m * contact_point.normal;
  if (norm(offset_m - offset_m_) > kThrown_ratio * way_m) return;
  contact_point_ = contact_point;
  outward_ = contact_point.normal;
  offset_m_ = offset_m;
}

}  // namespace tact::model::contact
