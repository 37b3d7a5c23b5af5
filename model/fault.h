// SPDX-License-Identifier: Apache-2.0
// fault.h - everything that can limit or stop the force, by number.
//
// 0 is none; 1 to 99 is a limit that is acting while the loop goes on; 100 and above latch: force
// goes to zero until an operator resets (supervisor.h) or, where its remedy says so, starts tactd
// again. Numbers are never reused.
#pragma once

#include <cstdint>
#include <span>

#include "model/rt.h"

namespace tact::model {

enum class Fault : std::uint16_t {
  kNone = 0,
  kSampleHeld = 1,
  kSampleStale = 2,
  kNotArmed = 3,
  kOutsideWorkspace = 4,
  kForceLimited = 5,
  kTorqueLimited = 6,
  kSlewLimited = 7,
  kRampingUp = 8,
  kLawSaturated = 9,
  kTooFast = 10,
  kEnergyLimited = 11,
  kContinuousLimited = 12,
  kPowerLimited = 13,
  kToolInside = 14,
  kContactLost = 15,
  kClutchPressed = 16,
  kUnknown = 100,  // never raised: what is said of a number that the table does not have
  kForceNotFinite = 101,
  kSampleNotFinite = 102,
  kDeviceLost = 103,
  kDeviceFailed = 104,
  kLoopLate = 105,
  kLawBroke = 106,
  kEmergencyStop = 107,
  kLinesDiffer = 108,
  kLinesLost = 109,
  kDeadManReleased = 110,
  kBusDown = 111,
  kBusOff = 112,
  kDriveFault = 113,
  kDriveSilent = 114,
  kDeviceUnplugged = 115,
  kDeviceGarbled = 116,
  kHomingLost = 117,
  kForceOff = 118,
  kPowerLost = 119,
  kLoopStalled = 120,
  kDeviceStalled = 121,
  kLoopRanAway = 122,
  kForbiddenCall = 123,
  kGuardianLost = 124,
  kGripFlaps = 125,
  kForeignCommand = 126,
  kEnergyOverdrawn = 130,
  kPowerExceeded = 131,
};

constexpr bool latches(Fault fault) RT_SAFE { return static_cast<std::uint16_t>(fault) >= 100; }

struct FaultEntry {
  Fault fault;
  const char* name;    // short, for a status line
  const char* cause;   // what happened
  const char* remedy;  // what to do
};

/// All entries, ascending by number. None of the texts is blank.
std::span<const FaultEntry> fault_table();
/// The entry of one fault; kUnknown's of a number that the table does not have.
const FaultEntry& describe(Fault fault);

}  // namespace tact::model
