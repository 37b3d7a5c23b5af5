// SPDX-License-Identifier: Apache-2.0
// object_dictionary.h - what a CiA 402 drive keeps under index and sub-index, and its SDO server.
//
//     request  2F/2B/27/23 index sub data    -> 60 index sub         expedited download, 1..4 bytes
//              40 index sub                  -> 4F/4B/47/43 ... data expedited upload
//     refused                                -> 80 index sub code    abort, u32
//
// A drive may answer an upload without its size, 42, and may lack what CiA 402 calls optional.
//
// Rules of CiA 301: a PDO is changed only while bit 31 of its COB-id disables it, its mapping only
// while sub 0 is zero, and neither while the node is operational. Sources: CiA 301 and CiA 402-2 as
// the vendors' manuals quote them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tests/rig/emulators/can/wire.h"

namespace tact::rig {

enum class SdoAbort : std::uint32_t {
  kNone = 0,
  kUnknownCommand = 0x05040001,
  kUnsupportedAccess = 0x06010000,
  kReadOnly = 0x06010002,
  kNoObject = 0x06020000,
  kNotMappable = 0x06040041,
  kMappingTooLong = 0x06040042,
  kContradiction = 0x06040043,
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

/// What a drive may do otherwise, each as vendors' objects or open stacks have it.
struct ObjectHabits {
  bool no_request_stays =
      false;  // 1800:01: bit 30, no remote request, is set and may not be cleared
  bool watch_off_first = false;  // 1016:01: a watch that is on is not written again (0x06040043)
  bool sizes_unsaid = false;     // uploads by 42
  std::vector<std::uint16_t> absent{};          // indices that it does not have
  int mode_shown = 10;                          // 6061, once 10 was written to 6060
  int guard_time_ms = 0, life_time_factor = 0;  // 100C, 100D as they were stored
  bool life_hides_host = false;    // with a life time a host that falls silent is not missed
  bool life_from_boot = false;     // its life time counts from boot-up, not from the first request
  std::uint32_t sync_id = 0x80;    // 1005 as it was stored
  int sync_period_us = 0;          // 1006 as it was stored: SYNC is missed after 1.5 of it
  int sync_counter = 0;            // 1019 as it was stored: a SYNC without a counter is none
  std::uint32_t second_watch = 0;  // 1016:02 as it was stored
  bool errors_bar_operational = false;  // an error of the bus (1001, bit 4) keeps it out of it
};

class ObjectDictionary {
 public:
  /// As after power-on. Torque is in 1/1000 of `rated_torque_Nm`.
  ObjectDictionary(int node, double rated_torque_Nm, ObjectHabits habits = {});

  /// The answer to one request frame.
  Sdo serve(std::span<const std::uint8_t> request, bool is_operational);

  bool has(std::uint16_t index, std::uint8_t sub = 0) const { return find(index, sub) != nullptr; }
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

  ObjectHabits habits_;
  std::vector<DictionaryEntry> entries_;
};

}  // namespace tact::rig
