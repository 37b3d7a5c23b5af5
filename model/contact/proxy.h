// SPDX-License-Identifier: Apache-2.0
// proxy.h - the god object of a sphere: where its centre would be if the organ were rigid.
//
// The proxy g is a point at the distance r from the surface, outside, r the radius of the sphere
// [C. Zilles, J. Salisbury, IROS 1995; D. Ruspini, K. Kolarov, O. Khatib, SIGGRAPH 1997]. The
// sphere's depth is |g - p|, p its centre, and the force points from p to g. g is the point of that
// offset surface that is nearest to p, found from where g was, so it never passes through the
// organ. It gets there no faster than
//
//     PX-1   |g' - g| <= kSlide_ratio |s|,   s the part of p' - p that is across g - p
//
// Where the nearest point moves faster (at an edge, beyond the middle of a thin part) g lags: it
// slides along the offset surface towards that point, so the force turns at a bounded rate, and a
// push straight in turns nothing. While it lags, what of g - p points out of the organ is at least
// 0, at g and where p is nearest, so a lagging proxy never pulls in.
#pragma once

#include "model/contact/contact_point.h"

namespace tact::model::contact {

/// Chosen: at the depth d in a body of curvature radius R the goal of g goes (R + r) / (R + r - d)
/// times as far as p.
inline constexpr double kSlide_ratio = 2.0;

class Proxy {
 public:
  /// The surface point that g is above. normal is along the force, distance_m is r less
  /// the depth.
  const ContactPoint& contact_point() const RT_SAFE { return contact_point_; }
  /// It is not at the nearest point.
  bool lags() const RT_SAFE { return lags_; }
  /// By how much the depth became larger in the last move than the work of its force explains, m;
  /// below 0: smaller.
  double lengthened_m() const RT_SAFE { return lengthened_m_; }

  /// The sphere comes from outside, to this contact point.
  void restart(const ContactPoint& contact_point, double radius_m) RT_SAFE;
  /// The sphere's centre is at p now and has moved there since the last call.
  void follow(const SurfaceView& surface, const Vec3& p_m, const Vec3& moved_m,
              double radius_m) RT_SAFE;

 private:
  void move_to(const SurfaceView& surface, const Vec3& p_m, double across_m,
               double radius_m) RT_SAFE;
  Vec3 depth_m(const Vec3& p_m) const RT_SAFE;
  Vec3 outward_of(const ContactPoint& nearest, const Vec3& line_m, double radius_m) const RT_SAFE;
  void slide(const SurfaceView& surface, const Vec3& goal_m, double way_m, double radius_m) RT_SAFE;

  ContactPoint contact_point_;
  Vec3 offset_m_;  // g
  Vec3 outward_;   // of the offset surface in g, unit
  bool lags_ = false;
  double lengthened_m_ = 0.0;
};

}  // namespace tact::model::contact
