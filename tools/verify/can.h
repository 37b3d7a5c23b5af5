// SPDX-License-Identifier: Apache-2.0
// can.h - frames in vector files: hexadecimal bytes, and all fields of a case, none left
// out.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/can/can_frame.h"
#include "tools/verify/report.h"

namespace tact::tools::verify {

std::string to_hex(std::span<const std::uint8_t> bytes);
/// An odd number of digits or another letter is damage, and no bytes.
std::vector<std::uint8_t> from_hex(const std::string& digits, Report& report);

/// A data frame with these bytes; an identifier or a length that cannot be is damage.
hal::can::CanFrame frame_of(std::uint32_t id, const std::string& digits, Report& report);

/// Both must have the same fields with equal values.
void compare_equal(Report& report, const nlohmann::json& got, const nlohmann::json& want);

/// What an encoder made, against identifier, data, length and the bytes of the whole frame, which
/// must also read back as the same frame.
void compare_encoded(Report& report, const std::optional<hal::can::CanFrame>& frame,
                     const nlohmann::json& want);

/// Whether a decoder of this frame turns down what is not that frame: fewer or more bytes, another
/// node, a remote request.
template <class Decode>
bool refuses_damage(const hal::can::CanFrame& sound, Decode decode) {
  hal::can::CanFrame shorter = sound, longer = sound, remote = sound, stranger = sound;
  if (sound.length > 0) --shorter.length;
  if (sound.length < 8) ++longer.length;
  remote.rtr = true;
  stranger.id ^= 0x20;  // a bit of the node, in both protocols
  return (sound.length == 0 || !decode(shorter)) && (sound.length == 8 || !decode(longer)) &&
         !decode(remote) && !decode(stranger);
}

/// One reply, as its decoder reads it for a node and `to_json` prints it; and the damaged ones.
template <class Decode, class ToJson>
nlohmann::json decoded(const hal::can::CanFrame& frame, int node, Decode decode, ToJson to_json,
                       Report& report) {
  const auto read = [&](const hal::can::CanFrame& f) { return decode(f, node); };
  report.equal("refuses damage", refuses_damage(frame, read), true);
  const auto value = read(frame);
  return value ? to_json(*value) : nlohmann::json::object();
}

/// In can_cia402.cc.
void verify_cia402(const nlohmann::json& file, Report& report);
/// In can_moteus.cc.
void verify_moteus(const nlohmann::json& file, Report& report);
/// In falcon_boot.cc: the requests and words that wake a Falcon, each of the order is a case.
void verify_falcon_boot(const nlohmann::json& ftdi, Report& report);

}  // namespace tact::tools::verify
