// SPDX-License-Identifier: Apache-2.0
#include "model/contact/blade.h"

namespace tact::model::contact {
namespace {

/// Six times the volume of a tetrahedron; its sign is the side of d on the triangle a, b, c.
double side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) RT_SAFE {
  return dot(cross(b - a, c - a), d - a);
}

bool passes(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p, const Vec3& q) RT_SAFE {
  const double above = side(a, b, c, p), below = side(a, b, c, q);
  if (above * below > 0.0 || above == below) return false;  // one side, or in the plane
  const double u = side(p, q, a, b), v = side(p, q, b, c), w = side(p, q, c, a);
  return (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
}

}  // namespace

BladeSweep sweep(const Blade& blade, const Tool& from, const Tool& to) RT_SAFE {
  return {.from_a_m = from.position_m + rotate(from.orientation, blade.a_m),
          .from_b_m = from.position_m + rotate(from.orientation, blade.b_m),
          .to_a_m = to.position_m + rotate(to.orientation, blade.a_m),
          .to_b_m = to.position_m + rotate(to.orientation, blade.b_m)};
}

bool crosses(const BladeSweep& s, const Vec3& p_m, const Vec3& q_m) RT_SAFE {
  if (!is_finite(s.from_a_m + s.from_b_m + s.to_a_m + s.to_b_m + p_m + q_m)) return false;
  return passes(s.from_a_m, s.from_b_m, s.to_b_m, p_m, q_m) ||
         passes(s.from_a_m, s.to_b_m, s.to_a_m, p_m, q_m);
}

}  // namespace tact::model::contact
