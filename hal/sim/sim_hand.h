// SPDX-License-Identifier: Apache-2.0
// sim_hand.h - where the simulated hand pulls and turns the handle: by its script or a mouse.
//
//     F = k (x_h - x) + b (v_h - v)        x_h, v_h from here; x, v of the handle, W
//
// The script is a path of waypoints (model/hand_path.h). While a person steers, the
// script's time stops and x_h walks to the mouse with at most 0.5 m/s and 5 m/s^2; a second
// after the last steering it walks back the same way and the script goes on. A script that jumps,
// as a repeated one may, is joined by such a walk too: x_h never jumps.
#pragma once

#include "model/hand_path.h"
#include "model/types.h"

namespace tact::hal::sim {

using model::Vec3;

class SimHand {
 public:
  /// The path has at least one waypoint.
  explicit SimHand(model::HandSettings settings);

  /// A person wants the hand here, and the tool turned so; holds for one second. NaN is ignored.
  void steer(const model::HandWaypoint& wanted) RT_SAFE;
  void step(double dt_s) RT_SAFE;

  const model::HandSettings& settings() const RT_SAFE { return settings_; }
  const Vec3& position_W_m() const RT_SAFE { return at_.position_m; }
  const Vec3& velocity_mps() const RT_SAFE { return velocity_mps_; }
  const Vec3& rotation_rad() const RT_SAFE { return at_.rotation_rad; }
  double grip_ratio() const RT_SAFE { return at_.grip_ratio; }
  bool is_steered() const RT_SAFE;

 private:
  bool follow_script(double dt_s) RT_SAFE;
  void walk_to(const model::HandWaypoint& goal, double dt_s) RT_SAFE;

  model::HandSettings settings_;
  model::HandWaypoint at_;
  Vec3 velocity_mps_;
  double script_s_ = 0.0;
  bool on_script_ = true;
  model::HandWaypoint steered_;
  double unsteered_s_ = 1e9;  // since the last steering
};

}  // namespace tact::hal::sim
