// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/sim_hand.h"

#include <algorithm>
#include <utility>

namespace tact::hal::sim {
namespace {

using model::HandWaypoint;

// Chosen. The walk's numbers are the header's; 0.5 m/s within 0.1 s are its 5 m/s^2.
constexpr double kSteeringHolds_s = 1.0;
constexpr double kWalkSpeed_mps = 0.5;
constexpr double kWalkAcceleration_mps2 = 5.0;
constexpr double kWalkTime_s = 0.1;  // slows down near the goal, within that acceleration
constexpr double kTurnSpeed_radps = 2.0;
constexpr double kGripSpeed_per_s = 5.0;
constexpr double kArrived_m = 1e-5, kArrived_rad = 1e-4, kArrivedGrip = 1e-3;
// Faster than any hand: the script has jumped.
constexpr double kJump_mps = 5.0, kJump_radps = 30.0;

/// v, or the vector of this length along it.
Vec3 shortened(const Vec3& v, double longest) RT_SAFE {
  const double length = norm(v);
  return length > longest ? v * (longest / length) : v;
}

bool has_arrived(const HandWaypoint& a, const HandWaypoint& b) RT_SAFE {
  return norm(a.position_m - b.position_m) < kArrived_m &&
         norm(a.rotation_rad - b.rotation_rad) < kArrived_rad &&
         std::abs(a.grip_ratio - b.grip_ratio) < kArrivedGrip;
}

}  // namespace

SimHand::SimHand(model::HandSettings settings)
    : settings_(std::move(settings)),
      at_(model::hand_target(settings_.path, settings_.repeat, 0.0)) {}

bool SimHand::is_steered() const RT_SAFE { return unsteered_s_ < kSteeringHolds_s; }

void SimHand::steer(const HandWaypoint& wanted) RT_SAFE {
  if (!is_finite(wanted.position_m) || !is_finite(wanted.rotation_rad) ||
      !std::isfinite(wanted.grip_ratio))
    return;
  steered_ = wanted;
  steered_.grip_ratio = std::clamp(wanted.grip_ratio, 0.0, 1.0);
  unsteered_s_ = 0.0;
}

void SimHand::step(double dt_s) RT_SAFE {
  if (!(dt_s > 0.0)) return;
  if (is_steered()) {
    unsteered_s_ += dt_s;
    // The script's time stops meanwhile: the hand comes back to where it was led away.
    on_script_ = false;
    walk_to(steered_, dt_s);
    return;
  }
  if (on_script_ && follow_script(dt_s)) return;
  const HandWaypoint goal = model::hand_target(settings_.path, settings_.repeat, script_s_);
  walk_to(goal, dt_s);
  on_script_ = has_arrived(at_, goal);
}

/// One step of the script, unless the script jumps there.
bool SimHand::follow_script(double dt_s) RT_SAFE {
  const HandWaypoint last = model::hand_target(settings_.path, settings_.repeat, script_s_);
  script_s_ += dt_s;
  const HandWaypoint next = model::hand_target(settings_.path, settings_.repeat, script_s_);
  const Vec3 velocity_mps = (next.position_m - last.position_m) / dt_s;
  const Vec3 turn_radps = (next.rotation_rad - last.rotation_rad) / dt_s;
  if (!(norm(velocity_mps) <= kJump_mps && norm(turn_radps) <= kJump_radps)) {
    on_script_ = false;
    return false;
  }
  at_ = next;
  velocity_mps_ = velocity_mps;
  return true;
}

void SimHand::walk_to(const HandWaypoint& goal, double dt_s) RT_SAFE {
  const Vec3 wanted_mps =
      shortened((goal.position_m - at_.position_m) / kWalkTime_s, kWalkSpeed_mps);
  velocity_mps_ += shortened(wanted_mps - velocity_mps_, kWalkAcceleration_mps2 * dt_s);
  // The script may have been faster when the walk began.
  velocity_mps_ = shortened(velocity_mps_, kWalkSpeed_mps);
  at_.position_m += dt_s * velocity_mps_;
  at_.rotation_rad += shortened(goal.rotation_rad - at_.rotation_rad, kTurnSpeed_radps * dt_s);
  const double grip_step = kGripSpeed_per_s * dt_s;
  at_.grip_ratio += std::clamp(goal.grip_ratio - at_.grip_ratio, -grip_step, grip_step);
}

}  // namespace tact::hal::sim
