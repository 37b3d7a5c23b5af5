// SPDX-License-Identifier: Apache-2.0
// loft.h - a closed tool as a stack of rings with a point at each end.
#pragma once

#include <span>

#include "tools/make_meshes/meshes.h"

namespace tact::tools::make_meshes {

/// Rings of equally many points, counter-clockwise seen from `top`, from `bottom` to `top`:
/// n rings of m points give n m + 2 vertices and 2 n m triangles.
Shape make_loft(const model::Vec3& bottom_mm, const std::vector<std::vector<model::Vec3>>& ring_mm,
                const model::Vec3& top_mm);

/// A point of the outline of a tool that is turned on the z axis.
struct Turn {
  double z_mm = 0.0, radius_mm = 0.0;
  int steps = 1;  // rings from the turn before to this one
};

struct Turned {
  int points = 12;                         // of a ring
  double ball_mm = 1.0;                    // radius of the round tip, which touches the origin
  std::span<const double> ball_angle_deg;  // of its rings, seen from its centre, 0 at the tip
  std::span<const Turn> turns;             // from there upwards
  double top_mm = 0.0;
};
Shape make_turned(const Turned& tool);

}  // namespace tact::tools::make_meshes
