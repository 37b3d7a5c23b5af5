// SPDX-License-Identifier: Apache-2.0
// odrive_protocol.h - ODrive's CANSimple: numbers to frames and back, firmware 0.5 and 0.6.
//
//     identifier = node << 5 | command, 11 bits; node 0 to 63, command 0 to 31
//
// Payloads are little endian, numbers IEEE 754 binary32 in turn, turn/s, N m, A, V and degC, as the
// CAN protocol page of the ODrive documentation and the open firmware 0.5 have them (OD-1). A
// number that is NaN, infinite or too large for its field is refused in both directions: encoders
// and decoders then return nothing. The two generations share identifiers and lengths with other
// meanings; only 0.6 answers a request for its version.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hal/can/can_frame.h"

namespace tact::hal::odrive {

enum class OdriveCommand : std::uint8_t {
  kGetVersion = 0x00,  // 0.6
  kHeartbeat = 0x01,
  kEstop = 0x02,
  kSetAxisState = 0x07,
  kGetEncoderEstimates = 0x09,
  kGetEncoderCount05 = 0x0A,  // 0.5
  kSetControllerMode = 0x0B,
  kSetInputTorque = 0x0E,
  kSetLimits = 0x0F,
  kClearErrors = 0x18,
};

/// All that make a drive of 0.5 or 0.6 act or change, those above included: only one host may
/// send them. Among them position, velocity, gains, reboot, parameters (0x04, 0.6).
inline constexpr std::array<std::uint8_t, 17> kOdriveActs{0x02, 0x04, 0x06, 0x07, 0x0B, 0x0C,
                                                          0x0D, 0x0E, 0x0F, 0x10, 0x11, 0x12,
                                                          0x16, 0x18, 0x19, 0x1A, 0x1B};

enum class OdriveAxisState : std::uint32_t {
  kIdle = 1,
  kFullCalibration = 3,
  kIndexSearch = 6,
  kClosedLoop = 8,
  kHoming = 11,
};
enum class OdriveControlMode : std::uint32_t { kVoltage, kTorque, kVelocity, kPosition };
enum class OdriveInputMode : std::uint32_t { kPassThrough = 1 };

inline constexpr int kOdriveLargestNode = 63;

/// Who sent a frame and what it is; a remote request has an address too.
struct OdriveAddress {
  int node;
  OdriveCommand command;
};
OdriveAddress odrive_address(const can::CanFrame& frame) RT_SAFE;

// --- To the drive. Nothing if the node or a number is outside its range. ---

/// Eight bytes as the vendor's own tools send it, or the first four of them, which save 32 us.
enum class OdriveTorqueLength : std::uint8_t { kShort = 4, kPadded = 8 };
std::optional<can::CanFrame> odrive_input_torque(int node, double torque_Nm,
                                                 OdriveTorqueLength length) RT_SAFE;
std::optional<can::CanFrame> odrive_limits(int node, double velocity_turns_per_s,
                                           double current_A) RT_SAFE;
std::optional<can::CanFrame> odrive_axis_state(int node, OdriveAxisState state) RT_SAFE;
std::optional<can::CanFrame> odrive_controller_mode(int node, OdriveControlMode control,
                                                    OdriveInputMode input) RT_SAFE;
/// The axis stays disarmed until its errors are cleared.
std::optional<can::CanFrame> odrive_estop(int node) RT_SAFE;
/// `identify`: 0.6 blinks the drive's light.
std::optional<can::CanFrame> odrive_clear_errors(int node, bool identify) RT_SAFE;
/// A remote request for a reply, which has 8 bytes. It feeds the watchdog of a 0.5 drive like every
/// frame: never ask from a thread that outlives the loop.
std::optional<can::CanFrame> odrive_request(int node, OdriveCommand command) RT_SAFE;

// --- From the drive. Nothing unless it is a data frame of this node and message, whole and finite.

struct OdriveVersion {  // 0.6
  int firmware_major, firmware_minor;
};
std::optional<OdriveVersion> decode_odrive_version(const can::CanFrame& frame, int node) RT_SAFE;

struct OdriveHeartbeat {     // 0.6
  std::uint32_t axis_error;  // bits in odrive_errors.h
  std::uint8_t axis_state;   // OdriveAxisState, or one that we do not ask for
  std::uint8_t procedure_result;
  bool trajectory_done;
};
std::optional<OdriveHeartbeat> decode_odrive_heartbeat(const can::CanFrame& frame,
                                                       int node) RT_SAFE;

struct OdriveHeartbeat05 {
  std::uint32_t axis_error;  // bits in odrive_errors.h, other ones than those of 0.6
  std::uint8_t axis_state;
  bool motor_error;
  bool encoder_error;
  bool controller_error;
  bool trajectory_done;
};
std::optional<OdriveHeartbeat05> decode_odrive_heartbeat_05(const can::CanFrame& frame,
                                                            int node) RT_SAFE;

struct OdriveEstimates {
  double position_turns;
  double velocity_turns_per_s;
};
std::optional<OdriveEstimates> decode_odrive_estimates(const can::CanFrame& frame,
                                                       int node) RT_SAFE;

struct OdriveCount05 {  // 0.5: of the encoder itself, not of the estimates
  std::int32_t shadow;  // since power-on, or absolute; over turns
};
std::optional<OdriveCount05> decode_odrive_count_05(const can::CanFrame& frame, int node) RT_SAFE;

}  // namespace tact::hal::odrive
