// SPDX-License-Identifier: Apache-2.0
// odrive_table.h - CANSimple as a table: what each command carries, in firmware 0.5 and 0.6.
//
//     identifier = node << 5 | command        11 bits, payload little endian
//
// Units: turn, turn/s, N m, A, V, degC. Sources: the CAN protocol page of the ODrive documentation
// and the open firmware 0.5 (can_simple.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "tests/rig/emulators/can/wire.h"

namespace tact::rig {

enum class OdriveGeneration : std::uint8_t { k05 = 1, k06 = 2, kBoth = 3 };
enum class OdriveFrom : std::uint8_t { kDrive, kHost };

struct OdriveMessage {
  std::uint8_t command;
  std::string_view name;
  OdriveFrom from;
  OdriveGeneration generation;
  std::uint8_t size;
  std::array<WireField, 6> fields{};  // the first without a name ends them

  std::span<const WireField> used() const;
};

std::span<const OdriveMessage> odrive_messages();
/// nullptr: there is none of this name.
const OdriveMessage* odrive_message(std::string_view name, OdriveFrom from);
/// nullptr: this generation does not answer such a request.
const OdriveMessage* odrive_reply(std::uint8_t command, OdriveGeneration generation);

}  // namespace tact::rig
