// SPDX-License-Identifier: Apache-2.0
// recording_format.h - the files shared by tactd and tact-view: a viewer's recording, and the start
// of a tick log.
//
// Recording: FileHeader, Hello, meshes, then one FrameRecord per frame; little-endian, fixed sizes,
// so a damaged frame loses only itself. Every part has a CRC-32 (polynomial 0x04C11DB7, as zlib).
// In version 9, with a tracked operator, an operator record (bodies and figure,
// host/record/operator_record.h) follows each frame. tactd writes version 7.
// Tick log: LogStart and the rest of its header (tick_log.h), then `ticks` records of tick_bytes,
// each with its CRC, in the machine's own layout, then a complete recording of the same seconds.
// If `ticks` is 0, the records extend to the end of the file, without a recording.
// A finished file ends with its seal (model/io/seal.h), the SHA-256 of all bytes before.
#pragma once

#include <boost/crc.hpp>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>

#include "firmware/telemetry/telemetry_record.h"

namespace tact::firmware::telemetry {

inline constexpr char kRecordingMagic[8] = {'t', 'a', 'c', 't', 'r', 'e', 'c', '\n'};
inline constexpr std::uint32_t kRecordingVersion = 7;         // 7: with the scene's appearance
inline constexpr std::uint32_t kTrackedRecordingVersion = 9;  // 7 with the tracked operator

struct FileHeader {
  char magic[8] = {};
  std::uint32_t version = 0;
  std::uint32_t hello_bytes = 0, frame_bytes = 0;
  std::uint32_t setup_crc = 0;  // of Hello and meshes
  std::uint64_t mesh_bytes = 0;
};

struct FrameRecord {
  Frame frame;
  std::uint32_t crc = 0;  // of frame
  std::uint32_t pad = 0;
};

/// The last letter is the format's version.
inline constexpr char kLogMagic[8] = {'t', 'a', 'c', 't', 'l', 'o', 'g', 'A'};

struct LogStart {
  char magic[8] = {};
  std::uint32_t header_bytes = 0;  // everything before the first tick
  std::uint32_t tick_bytes = 0;    // the reader refuses a build with another size
  std::uint64_t ticks = 0;         // 0: up to the end of the file
};

inline std::uint32_t crc_of(const void* bytes, std::size_t size) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes, size);
  return crc.checksum();
}

inline std::uint32_t crc_of(const Frame& frame) { return crc_of(&frame, sizeof frame); }

inline std::uint32_t crc_of(const Hello& hello, std::span<const std::byte> mesh) {
  boost::crc_32_type crc;
  crc.process_bytes(&hello, sizeof hello);
  crc.process_bytes(mesh.data(), mesh.size());
  return crc.checksum();
}

/// The bytes at the start of a recording.
inline std::string recording_start(const Hello& hello, std::span<const std::byte> mesh,
                                   std::uint32_t version = kRecordingVersion) {
  FileHeader header{.version = version,
                    .hello_bytes = sizeof(Hello),
                    .frame_bytes = sizeof(Frame),
                    .setup_crc = crc_of(hello, mesh),
                    .mesh_bytes = mesh.size()};
  std::memcpy(header.magic, kRecordingMagic, sizeof header.magic);
  std::string out;
  out.append(reinterpret_cast<const char*>(&header), sizeof header);
  out.append(reinterpret_cast<const char*>(&hello), sizeof hello);
  return out.append(reinterpret_cast<const char*>(mesh.data()), mesh.size());
}

inline std::string recording_frame(const Frame& frame) {
  const FrameRecord record{.frame = frame, .crc = crc_of(frame)};
  return {reinterpret_cast<const char*>(&record), sizeof record};
}

}  // namespace tact::firmware::telemetry
