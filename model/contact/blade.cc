// SPDX-License-Identifier: Apache-2.0
#include "model/contact/blade.h"

#include <algorithm>

namespace tact::model::contact {
namespace {

/// Six times the volume of a tetrahedron; its sign is the side of d on the triangle a, b, c.
double side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) RT_SAFE {
  return dot(cross(b - a, c - a), d - a);
}

}  // namespace

bool passes(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p, const Vec3& q) RT_SAFE {
  const double above = side(a, b, c, p), below = side(a, b, c, q);
  if (above * below > 0.0 || above == below) return false;  // on one side, or in the plane
  // The line p-q passes all three edges on the same side: it goes through the triangle.
  const double u = side(p, q, a, b), v = side(p, q, b, c), w = side(p, q, c, a);
  return (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
}

BladeSweep sweep(const Blade& blade, const Tool& from, const Tool& to) RT_SAFE {
  return {.from_a_m = from.position_m + rotate(from.orientation, blade.a_m),
          .from_b_m = from.position_m + rotate(from.orientation, blade.b_m),
          .to_a_m = to.position_m + rotate(to.orientation, blade.a_m),
          .to_b_m = to.position_m + rotate(to.orientation, blade.b_m)};
}

SweepBox box_around(const BladeSweep& s) RT_SAFE {
  const auto low = [](const Vec3& a, const Vec3& b) RT_SAFE {
    return Vec3{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
  };
  const auto high = [](const Vec3& a, const Vec3& b) RT_SAFE {
    return Vec3{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
  };
  return {.low_m = low(low(s.from_a_m, s.from_b_m), low(s.to_a_m, s.to_b_m)),
          .high_m = high(high(s.from_a_m, s.from_b_m), high(s.to_a_m, s.to_b_m))};
}

bool misses(const SweepBox& box, const Vec3& p, const Vec3& q) RT_SAFE {
  const Vec3 &low = box.low_m, &high = box.high_m;
  return (p.x < low.x && q.x < low.x) || (p.x > high.x && q.x > high.x) ||
         (p.y < low.y && q.y < low.y) || (p.y > high.y && q.y > high.y) ||
         (p.z < low.z && q.z < low.z) || (p.z > high.z && q.z > high.z);
}

bool crosses(const BladeSweep& s, const Vec3& p_m, const Vec3& q_m) RT_SAFE {
  if (!is_finite(s.from_a_m + s.from_b_m + s.to_a_m + s.to_b_m + p_m + q_m)) return false;
  // A rotating edge sweeps a twisted quadrilateral. Both triangles share its diagonal: no gap.
  return passes(s.from_a_m, s.from_b_m, s.to_b_m, p_m, q_m) ||
         passes(s.from_a_m, s.to_b_m, s.to_a_m, p_m, q_m);
}

}  // namespace tact::model::contact
