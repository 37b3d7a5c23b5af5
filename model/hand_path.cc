// SPDX-License-Identifier: Apache-2.0
#include "model/hand_path.h"

#include <cmath>

namespace tact::model {
namespace {

Vec3 between(const Vec3& a, const Vec3& b, double ratio) RT_SAFE { return a + ratio * (b - a); }

/// R p
Vec3 turned(const Vec3& rotation_rad, const Vec3& p) RT_SAFE {
  return rotate(quat_from_rotation_vector(rotation_rad), p);
}

}  // namespace

HandWaypoint hand_target(const std::vector<HandWaypoint>& path, bool repeat,
                         double time_s) RT_SAFE {
  if (path.empty()) return {};
  const double end_s = path.back().time_s;
  // A path that starts over ends where it begins (scene_strokes.cc sees to it): no jump.
  if (repeat && end_s > 0.0 && time_s > end_s) time_s = std::fmod(time_s, end_s);
  if (!(time_s > path.front().time_s)) return path.front();
  if (time_s >= end_s) return path.back();
  std::size_t next = 1;
  while (path[next].time_s <= time_s) ++next;  // bounded by the path's length
  const HandWaypoint& from = path[next - 1];
  const HandWaypoint& to = path[next];
  const double s = (time_s - from.time_s) / (to.time_s - from.time_s);
  // Minimum jerk: speed and acceleration are zero at both ends, so strokes join without a kick.
  const double ratio = s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
  const Vec3 rotation_rad = between(from.rotation_rad, to.rotation_rad, ratio);
  const Vec3& c = to.straight_m;
  // p(t) = (p + R c)(t) - R(t) c
  const Vec3 straight_W_m = between(from.position_m + turned(from.rotation_rad, c),
                                    to.position_m + turned(to.rotation_rad, c), ratio);
  return {.time_s = time_s,
          .position_m = straight_W_m - turned(rotation_rad, c),
          .rotation_rad = rotation_rad,
          .grip_ratio = from.grip_ratio + ratio * (to.grip_ratio - from.grip_ratio)};
}

}  // namespace tact::model
