// SPDX-License-Identifier: Apache-2.0
// hd_library.h - the haptic device library of OpenHaptics (libHD.so), loaded by name when a scene
// asks for it.
//
// The library is proprietary and never part of tact: these are prototypes and numbers of our own,
// with the names and meanings of the vendor's published interface (HD-1). Most calls speak of the
// current device and answer nothing; errors wait on a stack, the newest on top. Lengths are mm,
// forces N, in the device's frame: x to the right, y up, z towards the operator (HD-2).
#pragma once

#include <string>

#include "model/fault.h"
#include "model/result.h"

namespace tact::hal::phantom {

using HdDevice = unsigned int;
inline constexpr HdDevice kHdNoDevice = 0xFFFF'FFFF;

struct HdError {
  unsigned int code = 0;  // 0: the stack is empty
  int internal_code = 0;
  HdDevice device = 0;
};

// What is asked for.
inline constexpr unsigned kHdCurrentButtons = 0x2000;    // bits (HD-8)
inline constexpr unsigned kHdCurrentTransform = 0x2052;  // 16 doubles, by columns
inline constexpr unsigned kHdModel = 0x2501, kHdSerialNumber = 0x2504;
inline constexpr unsigned kHdUsableWorkspace = 0x2551;  // least x y z, greatest x y z
inline constexpr unsigned kHdInputDof = 0x2553;
inline constexpr unsigned kHdCalibrationStyle = 0x2555;  // bits
inline constexpr unsigned kHdMaxStiffness = 0x2602;      // N/mm
inline constexpr unsigned kHdMaxForce = 0x2603, kHdContinuousForce = 0x2604;
// What is set.
inline constexpr unsigned kHdCurrentForce = 0x2700;
// What is switched.
inline constexpr unsigned kHdForceOutput = 0x4000, kHdMaxForceClamping = 0x4001;
inline constexpr int kHdButton1 = 1;  // of kHdCurrentButtons
// What a check of the calibration answers.
inline constexpr unsigned kHdCalibrated = 0x5000, kHdNeedsUpdate = 0x5001, kHdNeedsHand = 0x5002;
// Styles of calibration.
inline constexpr int kHdAuto = 2, kHdInkwell = 4;  // and 1, of the encoders by hand
// What a callback answers.
inline constexpr unsigned kHdDone = 0, kHdContinue = 1;

using HdCallback = unsigned int (*)(void* of);

struct HdFunctions {
  HdDevice (*init_device)(const char* name) = nullptr;  // null: the default device
  void (*disable_device)(HdDevice device) = nullptr;
  void (*make_current)(HdDevice device) = nullptr;
  void (*begin_frame)(HdDevice device) = nullptr;  // takes the device's state
  void (*end_frame)(HdDevice device) = nullptr;    // sends what was set
  HdError (*get_error)() = nullptr;
  void (*enable)(unsigned what) = nullptr;
  void (*disable)(unsigned what) = nullptr;
  unsigned char (*is_enabled)(unsigned what) = nullptr;
  void (*get_doubles)(unsigned what, double* values) = nullptr;
  void (*get_integers)(unsigned what, int* values) = nullptr;
  const char* (*get_string)(unsigned what) = nullptr;
  void (*set_doubles)(unsigned what, const double* values) = nullptr;
  unsigned (*check_calibration)() = nullptr;
  void (*update_calibration)(unsigned style) = nullptr;
  void (*set_scheduler_rate)(unsigned long rate_Hz) = nullptr;
  unsigned long (*schedule)(HdCallback callback, void* of, unsigned short priority) = nullptr;
  void (*unschedule)(unsigned long scheduled) = nullptr;
  void (*start_scheduler)() = nullptr;
  void (*stop_scheduler)() = nullptr;
};

/// Loads the file that device.phantom.library names and finds the functions in it. Unless the
/// person trusts it, it must be one of root's (vendor_sdk/library_trust.h).
model::Result<HdFunctions> load_hd(const std::string& library, bool trusted);

/// Empties the stack: the code of its oldest error, which is the cause; 0 without one.
unsigned take_hd_errors(const HdFunctions& hd);

/// What happened and the remedy; never blank.
std::string text_of_hd_error(unsigned code);
/// kDeviceUnplugged when no device answers, kForceOff when the forces were too much for the device,
/// else kDeviceFailed.
model::Fault fault_of_hd_error(unsigned code);

}  // namespace tact::hal::phantom
