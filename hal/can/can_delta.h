// SPDX-License-Identifier: Apache-2.0
// can_delta.h - a custom delta: from the turns of its three motors to the tool in W, and back.
//
//     theta_i = 2 pi direction_i (turns_i - zero_i) / gear        rad, from the motor's turns
//     tau_i   = direction_i (tau_g,i + s (J^T F)_i) / gear        N m, at the motor
//
// tau_g, N m, compensates gravity at the last measured pose; s, 0 to 1, scales F down to the limits
// of force and joint torque without changing its direction. Shared by all drives on CAN. Angles
// beyond the joint stops, or rods that cannot meet, mean a wrong zero: the homing is lost.
#pragma once

#include <optional>
#include <string>

#include "hal/can/can_settings.h"
#include "hal/delta/delta_dynamics.h"
#include "hal/delta/delta_kinematics.h"
#include "hal/device.h"
#include "hal/fault_latch.h"
#include "hal/velocity_observer.h"
#include "model/result.h"

namespace tact::hal::can {

class CanDelta {
 public:
  /// `gravity_mps2`: where down is for the base (hal/mounting.h).
  CanDelta(const DeltaSettings& delta, const CanSettings& can,
           const Vec3& gravity_mps2 = delta::kGravity_W_mps2);

  /// Set-up: the arms rest at home_rad now; sets the zero from that.
  void home_on_jig(const delta::Joints& motor_turns);
  /// Set-up: an error if these turns are outside the joint stops or give no pose.
  std::optional<model::Error> check_home(const delta::Joints& motor_turns) const;

  delta::Joints theta_rad(const delta::Joints& motor_turns) const RT_SAFE;
  /// Tool pose and velocity of a sample taken at stamp_ns. A cause: the homing is lost, and `tool`
  /// is unchanged.
  std::optional<FaultCause> measure(const delta::Joints& motor_turns, std::int64_t stamp_ns,
                                    Tool& tool) RT_SAFE;
  /// At the motors, for a force at the tool in W, gravity of the last pose included, all times
  /// `ratio`. Zero before the first pose; gravity alone for a force that is not finite.
  delta::Joints motor_torques_Nm(const Vec3& force_N, double ratio = 1.0) const RT_SAFE;

  /// `delay_s`: from position to force, beyond one hold; `counts_per_turn` of an arm.
  DeviceInfo info(std::string name, double counts_per_turn, double delay_s) const;

 private:
  std::optional<FaultCause> doubt(const delta::Joints& theta_rad,
                                  const delta::DeltaForward& pose) const RT_SAFE;

  DeltaSettings settings_;
  Vec3 gravity_D_mps2_;
  delta::DeltaKinematics delta_;
  delta::Joints direction_{}, zero_turns_{}, home_rad_{};
  VelocityObserver velocity_;
  delta::DeltaPose pose_;
  bool has_pose_ = false;
  std::int64_t stamp_ns_ = 0;
};

/// "arm 2 (node 2 on can0)".
std::string can_arm_name(std::size_t axis, const CanSettings& can);
/// Remedy for an arm whose positions on the jig differ.
inline constexpr const char* kMovesOnJig =
    "moves, or two drives have this node id: let the arms rest on the jig until tactd is ready, "
    "and "
    "give each drive a node id of its own";

/// What a cause of a lost homing means, with the remedy; empty for other causes.
std::string homing_fault_detail(const FaultCause& cause, const DeltaSettings& delta);
/// What a silent or jumping drive means, with the remedy; `position`: what is missed. Empty for
/// other causes.
std::string silence_fault_detail(const FaultCause& cause, const char* position);

}  // namespace tact::hal::can
