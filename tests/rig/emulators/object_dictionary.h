// SPDX-License-Identifier: Apache-2.0
// object_dictionary.h - what a CiA 402 drive keeps under index and sub-index, and its SDO server.
//
//     request  2F/2B/27/23 index sub data    -> 60 index sub         expedited download, 1..4 bytes
//              40 index sub                  -> 4F/4B/47/43 ... data expedited upload
//     refused                                -> 80 index sub code    abort, u32
//
// Rules of CiA 301: a PDO is changed only while bit 31 of its COB-id disables it, its mapping only
// while sub 0 is zero, and neither while the node is operational. Sources: CiA 301 and CiA 402-2 as
// the makers' manuals quote them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tests/rig/emulators/wire.h"

namespace tact::rig {

enum class SdoAbort : std::uint32_t {
  kNone = 0,
  kUnknownCommand = 0x05040001,
  kUnsupportedAccess = 0x06010000,
  kReadOnly = 0x06010002,
  kNoObject = 0x06020000,
  kNotMappable = 0x06040041,
  kMappingTooLong = 0x06040042,
  kWrongLength = 0x06070010,
  kNoSubIndex = 0x06090011,
  kBadValue = 0x06090030,
  kWrongState = 0x08000022,
};

struct DictionaryEntry {
  std::uint16_t index;
  std::uint8_t sub;
  WireType type;
  bool is_writable;
  bool is_mappable;
  std::int64_t value;
};

using Sdo = std::array<std::uint8_t, 8>;
/// The frame that refuses.
Sdo sdo_abort(std::uint16_t index, std::uint8_t sub, SdoAbort code);

class ObjectDictionary {
 public:
  /// As after power-on. Torque is in 1/1000 of `rated_torque_Nm`.
  ObjectDictionary(int node, double rated_torque_Nm);

  /// The answer to one request frame.
  Sdo serve(std::span<const std::uint8_t> request, bool is_operational);

  /// Of an object that exists; else 0.
  std::int64_t get(std::uint16_t index, std::uint8_t sub = 0) const;
  void set(std::uint16_t index, std::uint8_t sub, std::int64_t value);

  /// Mapped objects to bytes and back; `mapping`: 0x1A00 or 0x1600. False: the length differs.
  std::size_t pack(std::uint16_t mapping, std::span<std::uint8_t, 8> payload) const;
  bool unpack(std::uint16_t mapping, std::span<const std::uint8_t> payload);

 private:
  std::uint8_t mapped_count(std::uint16_t mapping) const;
  DictionaryEntry* find(std::uint16_t index, std::uint8_t sub);
  const DictionaryEntry* find(std::uint16_t index, std::uint8_t sub) const;
  SdoAbort download(std::uint16_t index, std::uint8_t sub, std::span<const std::uint8_t> data,
                    bool is_operational);
  SdoAbort check_pdo(const DictionaryEntry& entry, std::int64_t value, bool is_operational) const;
  SdoAbort check_mapping(const DictionaryEntry& entry, std::int64_t value) const;

  std::vector<DictionaryEntry> entries_;
};

}  // namespace tact::rig
