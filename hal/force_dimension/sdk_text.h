// SPDX-License-Identifier: Apache-2.0
// sdk_text.h - what the numbers of Force Dimension's library mean, for a person.
//
// Source: the vendor's documentation (SDK 3.17, dhdc.h): error codes, words of dhdGetStatus, causes
// of forces that the device switched off by itself.
#pragma once

#include <array>

#include "hal/force_dimension/sdk_library.h"
#include "model/fault.h"

namespace tact::hal::force_dimension {

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
/// kDeviceUnplugged when nobody answers, else kDeviceFailed.
model::Fault fault_of_sdk_error(int code) RT_SAFE;
/// Why the device switched its forces off, and the remedy; never blank.
const char* force_off_text(int cause);

}  // namespace tact::hal::force_dimension
