// SPDX-License-Identifier: Apache-2.0
// odrive_velocity_limit.h - what an ODrive's velocity limit V leaves of torque and motion.
//
//     torque along the motion <= (V - v) g        while enable_torque_mode_vel_limit is on
//     |v| > 1.2 V  stops the drive                while enable_overspeed_error is on
//
// The vendor's defaults: both on, V = 2 turn/s, g = 1/6 N m/(turn/s). CANSimple sets V (Set_Limits)
// and reads none of these back, so tact evaluates V as if the first were on: it may be (OD-4).
#pragma once

#include <string>

#include "hal/odrive/odrive_delta.h"
#include "model/device_settings.h"
#include "model/result.h"

namespace tact::hal::odrive {

struct OdriveVelocityLimit {
  double motor_torque_Nm = 0.0;    // that the delta may ask of a motor
  double uncut_turns_per_s = 0.0;  // up to here all of it passes; negative: not even at rest
  double uncut_mps = 0.0;          // of the hand, in the middle of the workspace
  double stops_mps = 0.0;          // of the hand: the drive stops
  double least_turns_per_s = 0.0;  // V that lets all torque pass at 1 m/s of the hand
};
/// For a limit V of the motors, turn/s, > 0.
OdriveVelocityLimit odrive_velocity_limit(const can::DeltaSettings& delta,
                                          double limit_turns_per_s);

/// What a person should know, with numbers and the remedy; empty: nothing. An error for a scene
/// whose own limit may cut torque at rest.
model::Result<std::string> check_odrive_velocity_limit(const model::DeviceSettings& settings);

}  // namespace tact::hal::odrive
