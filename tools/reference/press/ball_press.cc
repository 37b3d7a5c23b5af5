// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/press/ball_press.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tact::tools::reference {
namespace {

using model::Vec3;

constexpr double kReach = 2.0;      // of the ball's radius
constexpr double kTouching = 3e-3;  // of the ball's radius: nearer is a touch

}  // namespace

BallContact ball_on(const OrganBody& body, const Circle& tip, double depth_m) {
  BallContact contact{.radius_m = tip.radius_m,
                      .centre_m = tip.at_m - tip.radius_m * tip.axis,
                      .along_m = depth_m,
                      .face = {}};
  const Circle reach{tip.at_m, tip.axis, kReach * tip.radius_m};
  const auto may_touch = faces_within(body, reach);
  for (std::size_t f = 0; f < body.face.size(); ++f)
    if (may_touch(f)) contact.face.push_back({body.face[f][0], body.face[f][1], body.face[f][2]});
  return contact;
}

double touched_radius_m(const OrganBody& body, const BallContact& contact, const Vec3& axis,
                        const std::vector<Vec3>& displacement_m) {
  const Vec3 centre_m = contact.centre_m + contact.along_m * axis;
  double area_m2 = 0.0;
  for (const auto& corners : contact.face) {
    std::array<Vec3, 3> p{};
    double touching = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = body.mesh.node_m[corners[k]] + displacement_m[corners[k]];
      if (norm(p[k] - centre_m) < (1.0 + kTouching) * contact.radius_m) touching += 1.0 / 3.0;
    }
    // Tissue that folds in over the ball's widest circle is not seen along the way.
    const double seen_m2 = -0.5 * dot(cross(p[1] - p[0], p[2] - p[0]), axis);
    area_m2 += touching * std::max(0.0, seen_m2);
  }
  return std::sqrt(area_m2 / std::numbers::pi);
}

}  // namespace tact::tools::reference
