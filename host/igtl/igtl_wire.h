// SPDX-License-Identifier: Apache-2.0
// igtl_wire.h - the bytes of OpenIGTLink: header, checksum, and the messages that tact reads and
// writes.
//
//     header: u16 version, char[12] type, char[20] device, u64 time, u64 body bytes, u64 CRC
//
// Big-endian. Time is 32 bits of seconds and 32 of fractions, UTC; 0: none. The body's checksum is
// CRC-64 (polynomial 0x42F0E1EBA9EA3693, from 0, not reflected). Lengths are mm there, m here.
// In version 2 an extended header precedes the content, and metadata follows it.
// Source: OpenIGTLink protocol, version 3, http://openigtlink.org. Pure functions.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "host/pose/coordinate_chain.h"
#include "model/result.h"

namespace tact::host::igtl {

inline constexpr std::size_t kHeaderBytes = 58;
inline constexpr std::size_t kTypeBytes = 12, kDeviceBytes = 20;

struct MessageHead {
  std::uint16_t version = 0;
  std::string type, device;
  double time_s = 0.0;  // UTC; 0: none
  std::uint64_t body_bytes = 0, crc = 0;
};

/// From exactly kHeaderBytes. Error: these are not the bytes of a header.
model::Result<MessageHead> read_head(std::string_view bytes);
std::uint64_t crc64(std::string_view bytes);

/// The part of a body between its extended header and its metadata.
struct Content {
  std::string_view bytes;
  bool is_tracked = true;  // false: its metadata has a TransformStatus other than OK
};
/// Error: the sizes of the parts exceed the body.
model::Result<Content> content_of(const MessageHead& head, std::string_view body);

/// The pose of a TRANSFORM or a POSITION with its orientation. Error: another size, a number that
/// is not finite, or no rotation.
model::Result<pose::Pose> pose_of(std::string_view type, std::string_view content);

/// Complete messages, version 1. `time_s` UTC.
std::string transform(std::string_view device, double time_s, const pose::Pose& pose,
                      double scale = 1.0);
/// The force in newtons.
std::string force_sensor(std::string_view device, double time_s, const double (&force_N)[3]);
struct Status {
  std::uint16_t code = 0;  // 1 good; the table in README.md
  std::int64_t subcode = 0;
  std::string name;  // at most 20 bytes
  std::string words;

  friend bool operator==(const Status&, const Status&) = default;
};
std::string status(std::string_view device, double time_s, const Status& status);

}  // namespace tact::host::igtl
