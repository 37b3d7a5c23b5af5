// SPDX-License-Identifier: Apache-2.0
// canopen_words.h - what a CANopen drive's codes mean, in words and with the remedy.
//
// Emergency codes of CiA 301 and CiA 402, and the abort codes of SDO transfers of CiA 301. A drive
// may send a code that only its vendor knows; it then gets the words of its group.
#pragma once

#include <cstdint>
#include <span>

#include "hal/cia402/canopen_frames.h"
#include "model/rt.h"

namespace tact::hal::cia402 {

struct CanopenWords {
  std::uint32_t code;
  std::uint32_t mask;    // the bits of a code that must agree: an exact code or a group of them
  const char* sentence;  // for a person: what happened, what to do
};

/// Exact codes first, then their groups, the last entry fits every code.
std::span<const CanopenWords> emergency_words() RT_SAFE;
std::span<const CanopenWords> sdo_abort_words() RT_SAFE;

const char* emergency_sentence(std::uint16_t code) RT_SAFE;
const char* sdo_abort_sentence(std::uint32_t code) RT_SAFE;

/// Why a drive in this state is not at work.
const char* nmt_sentence(NmtState state);

}  // namespace tact::hal::cia402
