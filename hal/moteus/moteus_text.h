// SPDX-License-Identifier: Apache-2.0
// moteus_text.h - what a moteus' mode and fault code mean, in words and with the remedy.
//
// Codes as the vendor's register reference (0x000, 0x00F) and the open firmware (fw/error.h) have
// them: 32 and above a fault, which ends torque; 96 and above a limit that acts while it runs.
#pragma once

#include <span>
#include <string>

#include "model/rt.h"

namespace tact::hal::moteus {

struct MoteusFaultText {
  int code;
  const char* message;  // for a person: what happened, what to do
};
std::span<const MoteusFaultText> moteus_fault_texts() RT_SAFE;

/// With its number, to search for in the vendor's pages.
std::string moteus_fault_message(int code);

/// "in position mode"; for a mode that is not known here "in another mode".
const char* moteus_mode_name(int mode) RT_SAFE;

constexpr bool is_moteus_limit(int code) RT_SAFE { return code >= 96; }

}  // namespace tact::hal::moteus
