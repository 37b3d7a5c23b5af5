// SPDX-License-Identifier: Apache-2.0
// canopen_frames.h - the few CANopen frames that a drive needs, to bytes and back (CN-1).
//
// CiA 301, little endian, node n from 1 to 127. Identifiers: NMT 0x000, SYNC 0x080, EMCY 0x080 + n,
// SDO reply 0x580 + n, SDO request 0x600 + n, heartbeat 0x700 + n. An SDO carries up to four bytes
// ("expedited"); nothing longer is asked for, so a longer reply counts as none. Encoders return
// nothing for a node or a size that cannot be, decoders for any frame that is cut or from another
// node.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hal/can/can_frame.h"

namespace tact::hal::cia402 {

/// CN-1. EMCY has it as its base, too, and they never meet: SYNC has no node, a node is at least 1.
inline constexpr std::uint32_t kCanopenSyncId = 0x080;
inline constexpr int kCanopenLargestNode = 127;
inline constexpr int kCanopenAllNodes = 0;  // for NMT alone

enum class NmtCommand : std::uint8_t {
  kStart = 0x01,
  kStop = 0x02,
  kPreOperational = 0x80,
  kResetNode = 0x81,
  kResetCommunication = 0x82,
};
std::optional<can::CanFrame> canopen_nmt(NmtCommand command, int node_or_all) RT_SAFE;

/// All drives sample now, and send what they have.
can::CanFrame canopen_sync() RT_SAFE;

enum class NmtState : std::uint8_t {
  kBoot = 0x00,
  kStopped = 0x04,
  kOperational = 0x05,
  kPreOperational = 0x7F,
};
/// The host sends its own too: a drive that misses it stops.
std::optional<can::CanFrame> canopen_heartbeat(int node, NmtState state) RT_SAFE;
/// Nothing for a state that CiA 301 does not know.
std::optional<NmtState> decode_canopen_heartbeat(const can::CanFrame& frame, int node) RT_SAFE;

struct Emergency {
  std::uint16_t code;           // words in canopen_text.h; 0: the errors are gone
  std::uint8_t error_register;  // of object 1001
  std::array<std::uint8_t, 5> manufacturer;
};
std::optional<Emergency> decode_canopen_emergency(const can::CanFrame& frame, int node) RT_SAFE;

/// A value for an entry of a drive's object dictionary.
struct SdoWrite {
  std::uint16_t index;
  std::uint8_t sub;
  std::uint32_t value;  // a negative one as its two's complement
  std::uint8_t size;    // bytes: 1, 2 or 4, as the entry has
  bool operator==(const SdoWrite&) const = default;
};
/// Also nothing for a value that is larger than its size.
std::optional<can::CanFrame> canopen_sdo_download(int node, const SdoWrite& write) RT_SAFE;
std::optional<can::CanFrame> canopen_sdo_upload(int node, std::uint16_t index,
                                                std::uint8_t sub) RT_SAFE;

enum class SdoReplyKind : std::uint8_t { kDownloadDone, kUpload, kAbort };
struct SdoReply {
  SdoReplyKind kind;
  std::uint16_t index;  // compare it with the request: an old reply may come late
  std::uint8_t sub;
  std::uint8_t size = 0;  // of an upload, bytes, 1 to 4; 0: it is not said, the value has all four
  std::uint32_t value = 0;  // of an upload; of an abort its code, words in canopen_text.h
};
std::optional<SdoReply> decode_canopen_sdo(const can::CanFrame& frame, int node) RT_SAFE;

/// SYNC and NMT, which are for all nodes.
constexpr std::array<std::uint32_t, 2> kCanopenForAll{0x000, kCanopenSyncId};
/// Bases of RPDO 1 to 4 and of an SDO request: what a node gets from one host alone.
constexpr std::array<std::uint32_t, 5> kCanopenToNode{0x200, 0x300, 0x400, 0x500, 0x600};

/// Whether `node` can be one of a device.
constexpr bool is_canopen_node(int node) RT_SAFE {
  return node >= 1 && node <= kCanopenLargestNode;
}

}  // namespace tact::hal::cia402
