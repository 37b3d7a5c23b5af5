// SPDX-License-Identifier: Apache-2.0
// proxy.h - the god object of a sphere: the position of its centre if the organ were rigid.
//
// The proxy g is a point at the distance r from the surface, outside, r the radius of the sphere
// [C. Zilles, J. Salisbury, IROS 1995; D. Ruspini, K. Kolarov, O. Khatib, SIGGRAPH 1997]. The
// sphere's depth is |g - c|, c its centre, and the force points from c to g. The goal of g is the
// point of that offset surface nearest to c; the search starts at the last g, so g never passes
// through the organ. Its motion in a step is bounded:
//
//     PX-1   |g' - g| <= kSlide_ratio |across|,   across: the part of c' - c normal to g - c
//
// If the nearest point moves faster (at an edge, beyond the middle of a thin part), g lags: it
// slides along the offset surface towards that point, so the force turns at a bounded rate, and not
// at all during a push straight in. While it lags, the outward component of g - c is at least 0, at
// g and at the point nearest to c, so a lagging proxy never pulls the sphere in.
#pragma once

#include "model/contact/contact_point.h"

namespace tact::model::contact {

/// Chosen: at depth d in a body of curvature radius R the goal of g moves (R + r) / (R + r - d)
/// times as far as c.
inline constexpr double kSlide_ratio = 2.0;

class Proxy {
 public:
  /// The surface point below g; normal: direction of the force; distance_m: r minus the depth.
  const ContactPoint& contact_point() const RT_SAFE { return contact_point_; }
  /// True if g is not at the nearest point.
  bool lags() const RT_SAFE { return lags_; }
  /// Increase of the depth in the last move beyond what the work of the force explains, m; may be
  /// negative.
  double lengthened_m() const RT_SAFE { return lengthened_m_; }

  /// Starts at this contact point, for a sphere that comes from outside.
  void restart(const ContactPoint& contact_point, double radius_m) RT_SAFE;
  /// The sphere's centre has moved by moved_m since the last call.
  void follow(const SurfaceView& surface, const Vec3& centre_m, const Vec3& moved_m,
              double radius_m) RT_SAFE;

 private:
  void move_to(const SurfaceView& surface, const Vec3& centre_m, double across_m,
               double radius_m) RT_SAFE;
  Vec3 depth_m(const Vec3& centre_m) const RT_SAFE;
  Vec3 outward_of(const ContactPoint& nearest, const Vec3& line_m, double radius_m) const RT_SAFE;
  void slide(const SurfaceView& surface, const Vec3& goal_m, double way_m, double radius_m) RT_SAFE;

  ContactPoint contact_point_;
  Vec3 offset_m_;  // g
  Vec3 outward_;   // of the offset surface in g, unit
  bool lags_ = false;
  double lengthened_m_ = 0.0;
};

}  // namespace tact::model::contact
