// SPDX-License-Identifier: Apache-2.0
#include "model/mesh/turn.h"

#include <cmath>
#include <numbers>

namespace tact::model::mesh {

namespace {
constexpr double kDegrees = 180.0 / std::numbers::pi;
}

void turn(SurfaceMesh& mesh, const Quat& by) {
  for (std::vector<Vec3>* list : {&mesh.vertex_m, &mesh.face_normal, &mesh.vertex_normal})
    for (Vec3& v : *list) v = rotate(by, v);
  fill_records(mesh);
}

Quat turn_of(const Vec3& rotation_deg) {
  return quat_from_rotation_vector(rotation_deg / kDegrees);
}

Vec3 rotation_deg_of(const Quat& turn) {
  const Vec3 axis{turn.x, turn.y, turn.z};
  const double sine = norm(axis);
  // angle = 2 atan2(|v|, w), and the shorter way round
  const double angle_deg = 2.0 * kDegrees * std::atan2(sine, std::abs(turn.w));
  return (turn.w < 0.0 ? -angle_deg : angle_deg) * normalized(axis);
}

Quat turn_between(const Vec3& from, const Vec3& to) {
  const Vec3 across = cross(from, to);
  const double cosine = dot(from, to);
  if (cosine < -1.0 + 1e-12) {  // half a turn
    const Vec3 other = std::abs(from.x) < 0.5 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
    const Vec3 axis = normalized(cross(from, other));
    return {0.0, axis.x, axis.y, axis.z};
  }
  // q = (1 + a . b, a x b), made unit
  const double size = std::sqrt((1.0 + cosine) * (1.0 + cosine) + dot(across, across));
  return {(1.0 + cosine) / size, across.x / size, across.y / size, across.z / size};
}

}  // namespace tact::model::mesh
