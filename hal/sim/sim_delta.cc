// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/sim_delta.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "hal/delta/delta_at_tool.h"
#include "hal/saturation.h"
#include "hal/sim/sim_delta_model.h"
#include "model/ranges.h"

namespace tact::hal::sim {
namespace {

// Chosen: four steps a tick at 1 kHz.
constexpr double kLongestStep_s = 0.25e-3;
// A longer pause of the loop is cut to this: one call stays bounded.
constexpr double kMaxPhysics_s = 0.1;
constexpr double kMaxDelay_s = 0.1;
// 16 bits, chosen: fine beside the +-20 degrees of the wrist.
constexpr double kWristCountsPerTurn = 65536.0;
constexpr double kGripHalfWidth_m = 0.05;  // the hand holds the handle here, at both sides
constexpr double kGripperForce_N = 8.0, kGripperOpen_m = 0.025;  // as an omega.7's

double counted_rad(double angle_rad, double counts_per_turn) RT_SAFE {
  const double rad_per_count = 2.0 * std::numbers::pi / counts_per_turn;
  // The nearest count: a plain floor would be half a count low.
  return std::floor(angle_rad / rad_per_count + 0.5) * rad_per_count;
}

/// The nearest point of the workspace cylinder.
Vec3 inside_workspace_m(const Vec3& p_W) RT_SAFE {
  const double radius_m = std::hypot(p_W.y, p_W.z);
  const double shrink = radius_m > kWorkspaceRadius_m ? kWorkspaceRadius_m / radius_m : 1.0;
  return {std::clamp(p_W.x, -kWorkspaceHalfLength_m, kWorkspaceHalfLength_m), shrink * p_W.y,
          shrink * p_W.z};
}

}  // namespace

SimDelta::SimDelta(const SimDeviceSettings& device, const model::HandSettings& hand,
                   const Mounting& mounting)
    : settings_(device),
      mounting_(mounting),
      gravity_D_mps2_(direction_D(mounting.gravity_in_base_mps2())),
      delta_(kGeometry),
      hand_(hand),
      plant_({.coulomb_Nm = device.joint_friction_Nm,
              .viscous_Nms_per_rad = device.joint_damping_Nms_per_rad},
             point_D(inside_workspace_m(mounting.point_in_base(hand_.position_W_m()))),
             gravity_D_mps2_),
      wrist_(wrist_angles_rad(hand_.rotation_rad())),
      velocity_(device.observer_bandwidth_Hz, kJump_mps),
      angular_velocity_(device.observer_bandwidth_Hz, kJump_radps),
      shown_s_(-device.sample_delay_s) {
  history_.fill(state_now());  // at rest here since before the start
  // An end that is older than any delay: state_at always finds two states around its time.
  history_[kHistory - 1].time_s = -2.0 * kMaxDelay_s;
  measured_ = delta_.pose(plant_.position_D_m(), plant_.theta_rad());
  // The motors hold the arms from the start, or they would fall before the first write.
  motor_Nm_ = gravity_torques_Nm(kGeometry, kMasses, measured_, gravity_D_mps2_);
}

DeviceInfo SimDelta::info() const {
  DeviceInfo info{
      .name = "simulated delta 360 x 300 mm",
      .max_force_N = kMaxForce_N,
      .max_torque_Nm = kMaxTorque_Nm,
      .workspace_radius_m = kWorkspaceRadius_m,
      .workspace_half_length_m = kWorkspaceHalfLength_m,
      .grip = {GripKind::kForce, kGripperForce_N},
      .at_tool = delta_at_tool(
          delta_,
          {.viscous_Nms_per_rad = settings_.joint_damping_Nms_per_rad,
           .coulomb_Nm = settings_.joint_friction_Nm,
           .counts_per_turn = settings_.counts_per_turn,
           .delay_s = settings_.sample_delay_s},
          delta::workspace_samples_D(kWorkspaceRadius_m, kWorkspaceHalfLength_m, kMiddle_D_m)),
      .damping_key = "device.sim.joint_damping_Nms_per_rad"};
  if (!settings_.is_ideal) return info;
  info.name = "IDEAL simulated delta, to look at alone";
  info.caution =
      "device.kind \"sim-ideal\" is ideal: no friction, no delay, and damped as no real device is; "
      "do not evaluate stability with it";
  info.at_tool->damping_Ns_per_m += hand_.settings().damping_Ns_per_m;
  info.damping_key.clear();
  return info;
}

Vec3 SimDelta::true_position_W_m() const RT_SAFE { return point_W(plant_.position_D_m()); }

Fault SimDelta::read(Sample& sample, std::int64_t now_ns) RT_SAFE {
  sample.fresh = false;
  const Fault broken = faults_.device.load(std::memory_order_relaxed);
  if (broken != Fault::kNone) return broken;
  const int drops = faults_.drop_samples.load(std::memory_order_relaxed);
  if (drops > 0) {
    faults_.drop_samples.store(drops - 1, std::memory_order_relaxed);
    return Fault::kNone;
  }
  const State state = state_at(time_s_ - settings_.sample_delay_s);
  // Fails where the rods cannot meet (DK-3): no pose of this device.
  if (!measure(state, sample.tool)) return Fault::kDeviceFailed;
  sample.grip_gap_m = kGripperOpen_m * (1.0 - state.grip_ratio);
  sample.grip_speed_mps = kGripperOpen_m * -state.grip_rate_per_s;
  if (faults_.nan_sample.load(std::memory_order_relaxed)) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    sample.tool.position_m = {nan, nan, nan};
  }
  sample.stamp_ns = now_ns - std::llround(1e9 * (time_s_ - state.time_s));
  sample.sequence = ++sequence_;
  sample.fresh = true;
  return Fault::kNone;
}

/// Encoders, forward kinematics, observer: the way a real device would know its tool.
bool SimDelta::measure(const State& state, Tool& tool) RT_SAFE {
  delta::Joints theta_rad{};
  for (std::size_t i = 0; i < 3; ++i)
    theta_rad[i] = counted_rad(state.theta_rad[i], settings_.counts_per_turn);
  const delta::DeltaForward forward = delta_.forward(theta_rad);
  if (!forward.solved) return false;
  measured_ = delta_.pose(forward.far_m, theta_rad);
  const Vec3 wrist_rad{counted_rad(state.wrist_rad.x, kWristCountsPerTurn),
                       counted_rad(state.wrist_rad.y, kWristCountsPerTurn),
                       counted_rad(state.wrist_rad.z, kWristCountsPerTurn)};
  const double elapsed_s = state.time_s - shown_s_;
  shown_s_ = state.time_s;
  tool.position_m = point_W(forward.far_m);
  tool.velocity_mps = velocity_.step(tool.position_m, elapsed_s);
  tool.orientation = wrist_orientation(wrist_rad);
  tool.angular_velocity_radps =
      wrist_angular_velocity_radps(wrist_rad, angular_velocity_.step(wrist_rad, elapsed_s));
  tool.grip_ratio = state.grip_ratio;
  return true;
}

Fault SimDelta::write(const Wrench& wrench) RT_SAFE {
  const Fault broken = faults_.device.load(std::memory_order_relaxed);
  if (broken != Fault::kNone) return broken;
  if (!powered_ || !permitted_) {  // motors without power hold nothing
    motor_Nm_ = {};
    wrist_Nm_ = {};
    grip_N_ = 0.0;
    return Fault::kNone;
  }
  const bool sound = is_finite(wrench) && std::isfinite(wanted_grip_N_);
  grip_N_ = sound ? std::clamp(wanted_grip_N_, -kGripperForce_N, kGripperForce_N) : 0.0;
  const Wrench limited = sound ? Wrench{saturated(wrench.force_N, kMaxForce_N),
                                        saturated(wrench.torque_Nm, kMaxTorque_Nm)}
                               : Wrench{};
  // From the pose it has measured, not the true one: a real device knows no better.
  motor_Nm_ = delta::drive_torques_Nm(kGeometry, kMasses, measured_, gravity_D_mps2_,
                                      direction_D(limited.force_N), kMaxJointTorque_Nm);
  wrist_Nm_ = limited.torque_Nm;
  return sound ? Fault::kNone : Fault::kForceNotFinite;
}

void SimDelta::between_ticks(double elapsed_s) RT_SAFE {
  if (!(elapsed_s > 0.0)) return;
  steer_hand();
  const double simulated_s = std::min(elapsed_s, kMaxPhysics_s);
  // The small allowance keeps 1 ms at four steps when the caller's arithmetic says 1.0000001 ms.
  const int steps = std::max(1, static_cast<int>(std::ceil(simulated_s / kLongestStep_s - 1e-6)));
  // bound: kMaxPhysics_s / kLongestStep_s
  for (int i = 0; i < steps; ++i) step_physics(simulated_s / steps);
}

void SimDelta::steer_hand() RT_SAFE {
  HandTarget target;
  if (!hand_targets_.read(target)) return;
  const auto vector = [](const double (&v)[3]) { return Vec3{v[0], v[1], v[2]}; };
  // A target is a place of the tool. One shift for all that follow one another: pressed in between,
  // a clutch leaves the handle to the hand.
  if (!hand_.is_steered()) steering_shift_m_ = tool_shift_m_;
  const Vec3 handle_m = vector(target.position_m) - steering_shift_m_;
  const Vec3 in_base_m = inside_workspace_m(mounting_.point_in_base(handle_m));
  hand_.steer({.position_m = mounting_.point_W(in_base_m),
               .rotation_rad = vector(target.rotation_rad),
               .grip_ratio = target.grip_ratio});
}

void SimDelta::step_physics(double dt_s) RT_SAFE {
  const double grip_before = hand_.grip_ratio();
  hand_.step(dt_s);
  grip_rate_per_s_ = (hand_.grip_ratio() - grip_before) / dt_s;
  const model::HandSettings& hand = hand_.settings();
  plant_.step(dt_s, motor_Nm_,
              {.mass_kg = hand.mass_kg,
               .stiffness_N_per_m = hand.stiffness_N_per_m,
               .damping_Ns_per_m = hand.damping_Ns_per_m,
               .aim_m = point_D(mounting_.point_in_base(hand_.position_W_m())),
               .aim_velocity_mps = direction_D(mounting_.velocity_in_base(hand_.velocity_mps()))});
  // A hand that holds the handle at a distance r turns it through the same spring: k r^2.
  const double square_m2 = kGripHalfWidth_m * kGripHalfWidth_m;
  wrist_.step(dt_s, wrist_Nm_,
              {.stiffness_Nm_per_rad = hand.stiffness_N_per_m * square_m2,
               .damping_Nms_per_rad = hand.damping_Ns_per_m * square_m2,
               .aim_rad = wrist_angles_rad(hand_.rotation_rad())});
  time_s_ += dt_s;
  newest_ = (newest_ + 1) % kHistory;
  history_[newest_] = state_now();
}

SimDelta::State SimDelta::state_now() const RT_SAFE {
  return {.time_s = time_s_,
          .theta_rad = plant_.theta_rad(),
          .wrist_rad = wrist_.angles_rad(),
          .grip_ratio = hand_.grip_ratio(),
          .grip_rate_per_s = grip_rate_per_s_};
}

const SimDelta::State& SimDelta::remembered(std::size_t steps_ago) const RT_SAFE {
  return history_[(newest_ + kHistory - steps_ago) % kHistory];
}

/// Between the two steps around that time; the oldest remembered state if it is older.
SimDelta::State SimDelta::state_at(double time_s) const RT_SAFE {
  for (std::size_t ago = 0; ago + 1 < kHistory; ++ago) {
    const State& late = remembered(ago);
    const State& early = remembered(ago + 1);
    if (early.time_s > time_s) continue;
    const double span_s = late.time_s - early.time_s;
    const double s = span_s > 0.0 ? std::min((time_s - early.time_s) / span_s, 1.0) : 1.0;
    State out = early;
    out.time_s = time_s;
    for (std::size_t i = 0; i < 3; ++i)
      out.theta_rad[i] += s * (late.theta_rad[i] - early.theta_rad[i]);
    out.wrist_rad += s * (late.wrist_rad - early.wrist_rad);
    out.grip_ratio += s * (late.grip_ratio - early.grip_ratio);
    return out;
  }
  return remembered(kHistory - 1);
}

void SimDelta::stop() {
  powered_ = false;
  motor_Nm_ = {};
  wrist_Nm_ = {};
}

model::Result<std::unique_ptr<SimDelta>> make_sim_delta(SimDeviceSettings device,
                                                        const model::HandSettings& hand,
                                                        const Mounting& mounting) {
  model::ParameterList parameters;
  device.visit(parameters);
  if (auto wrong = parameters.check("device.sim")) return *wrong;
  for (const auto& [key, value] : {std::pair{"mass_kg", hand.mass_kg},
                                   {"stiffness_N_per_m", hand.stiffness_N_per_m},
                                   {"damping_Ns_per_m", hand.damping_Ns_per_m}})
    if (!model::is_not_negative(value))
      return model::Error{fmt::format("hand.{} is {}; it must be 0 or above", key, value)};
  if (hand.path.empty()) return model::Error{"the hand has no waypoint; give it at least one"};
  return std::make_unique<SimDelta>(device, hand, mounting);
}

}  // namespace tact::hal::sim
