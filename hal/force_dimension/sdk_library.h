// SPDX-License-Identifier: Apache-2.0
// sdk_library.h - Force Dimension's library, loaded by name when a scene asks for it.
//
// The library is proprietary and never part of tact: these are prototypes of our own, with the
// names and meanings of the vendor's documentation (Force Dimension SDK 3.17, dhdc.h). Every call
// takes the device's id last (FD-2). 0 is success, 1 "no new data yet" (time guard), 2 "force
// scaled down, direction kept"; negative is an error, whose code dhdErrorGetLast gives the same
// thread.
#pragma once

#include <array>
#include <string>

#include "model/fault.h"
#include "model/result.h"

namespace tact::hal::force_dimension {

inline constexpr int kSdkStatusTexts = 17;

/// Units: m, N, Nm, us (time guard), 125 us (watchdog); angles as a rotation matrix.
struct SdkFunctions {
  int (*device_count)() = nullptr;
  int (*open_id)(char index) = nullptr;  // id, or negative
  int (*close)(char id) = nullptr;
  int (*stop)(char id) = nullptr;
  int (*system_type)(char id) = nullptr;
  int (*status)(int words[kSdkStatusTexts], char id) = nullptr;
  int (*pose)(double* x_m, double* y_m, double* z_m, double rotation[3][3], char id) = nullptr;
  int (*set_force)(double fx_N, double fy_N, double fz_N, double tx_Nm, double ty_Nm, double tz_Nm,
                   double grip_N, char id) = nullptr;
  int (*enable_force)(unsigned char on, char id) = nullptr;
  int (*set_gravity_compensation)(int on, char id) = nullptr;
  int (*enable_expert_mode)() = nullptr;
  int (*set_time_guard)(int us, char id) = nullptr;
  int (*set_watchdog)(unsigned char duration_125us, char id) = nullptr;
  int (*error_get_last)() = nullptr;
  // A library may lack these.
  int (*set_effector_mass)(double kg, char id) = nullptr;
  int (*gripper_angle)(double* angle_rad, char id) = nullptr;
  int (*gripper_gap)(double* gap_m, char id) = nullptr;
  unsigned (*button_mask)(char id) = nullptr;
  int (*serial_number)(unsigned short* number, char id) = nullptr;
};

/// Loads the file that device.force_dimension.library names and finds the functions in it. Unless
/// the person trusts it, it must be one of root's (vendor_sdk/library_trust.h).
model::Result<SdkFunctions> load_sdk(const std::string& library, bool trusted);

/// Places in dhdGetStatus.
enum SdkStatus : int {
  kSdkPower = 0,
  kSdkConnected = 1,
  kSdkReset = 3,
  kSdkForce = 5,
  kSdkWristDetected = 8,
  kSdkError = 9,
  kSdkWristInit = 12,
  kSdkForceOffCause = 14,
};
using SdkStatusText = std::array<int, kSdkStatusTexts>;

/// What happened and the remedy, of dhdErrorGetLast; never blank.
const char* text_of_sdk_error(int code);
/// kDeviceUnplugged when no device answers, else kDeviceFailed.
model::Fault fault_of_sdk_error(int code) RT_SAFE;
/// Why the device switched its forces off, and the remedy; never blank.
const char* force_off_text(int cause);

}  // namespace tact::hal::force_dimension
