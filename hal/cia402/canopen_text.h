// SPDX-License-Identifier: Apache-2.0
// canopen_text.h - what a CANopen drive's codes mean, in words and with the remedy.
//
// Emergency codes of CiA 301 and CiA 402, and the abort codes of SDO transfers of CiA 301. A drive
// may send a code that only its vendor knows; it then gets the words of its group.
#pragma once

#include <cstdint>
#include <span>

#include "hal/cia402/canopen_frames.h"
#include "model/rt.h"

namespace tact::hal::cia402 {

struct CanopenText {
  std::uint32_t code;
  std::uint32_t mask;   // the bits of a code that must agree: an exact code or a group of them
  const char* message;  // for a person: what happened, what to do
};

/// Exact codes first, then their groups, the last entry fits every code.
std::span<const CanopenText> emergency_texts() RT_SAFE;
std::span<const CanopenText> sdo_abort_texts() RT_SAFE;

const char* emergency_message(std::uint16_t code) RT_SAFE;
const char* sdo_abort_message(std::uint32_t code) RT_SAFE;

/// Why a drive in this state is not at work.
const char* nmt_message(NmtState state);

}  // namespace tact::hal::cia402
