// SPDX-License-Identifier: Apache-2.0
// odrive_errors.h - what an ODrive's error bits mean, in words and with the remedy.
//
// Bits of `axis_error` in the heartbeat, and of 0.6's `active_errors` and `disarm_reason`, as the
// enumerations ODrive.Error (0.6) and AxisError (0.5) of the vendor's reference name them. The two
// generations use the same bits for different things.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "hal/odrive/odrive_protocol.h"

namespace tact::hal::odrive {

/// Who answers Get_Version speaks 0.6.
enum class OdriveGeneration : std::uint8_t { k05, k06 };

struct OdriveErrorText {
  std::uint32_t bit;
  const char* name;     // the vendor's, to search for
  const char* message;  // for a person: what happened, what to do
};

std::span<const OdriveErrorText> odrive_error_texts() RT_SAFE;     // 0.6
std::span<const OdriveErrorText> odrive_error_texts_05() RT_SAFE;  // 0.5

/// The words of the lowest bit that is set, an entry of its own for a bit that no table has.
/// Nothing for no error.
const OdriveErrorText* first_odrive_error(std::uint32_t axis_error) RT_SAFE;
const OdriveErrorText* first_odrive_error_05(std::uint32_t axis_error) RT_SAFE;

/// Which parts report an error in a heartbeat of 0.5: 1 motor, 2 encoder, 4 controller.
std::uint32_t odrive_parts_05(const OdriveHeartbeat05& heartbeat) RT_SAFE;

/// The text of the first error of a heartbeat's word, else of its parts; empty for none.
std::string odrive_error_message(OdriveGeneration generation, std::uint32_t axis_error,
                                 std::uint32_t parts);

}  // namespace tact::hal::odrive
