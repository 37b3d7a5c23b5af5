// SPDX-License-Identifier: Apache-2.0
// chunks.h - how tactd's data is divided: each message of the socket and each part of a file is one
// chunk, a header of 16 bytes and its content. Each has two CRC-32 (polynomial 0x04C11DB7, as in
// zlib).
//
// A damaged content loses its chunk. After a damaged header the reader skips to the next valid
// header; all chunks between are lost.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace tact::firmware::protocol {

enum class ChunkKind : std::uint32_t {
  kHead = 1,      // JSON: what runs, and the tables of the records (run_file.h)
  kMeshes = 2,    // vertices and triangles of organ and tool
  kTick = 3,      // a LoggedTick
  kFrame = 4,     // a Frame
  kOperator = 5,  // the tracked operator at the frame before it
  kVariant = 6,   // JSON: the law's numbers from the next tick on
};

struct ChunkHeader {
  ChunkKind kind = ChunkKind::kHead;
  std::uint32_t content_bytes = 0;
  std::uint32_t content_crc = 0;
  std::uint32_t header_crc = 0;  // of the twelve bytes before it
};
static_assert(sizeof(ChunkHeader) == 16);

std::uint32_t crc_of(std::string_view bytes);

/// Header and content.
std::string chunk_of(ChunkKind kind, std::string_view content);

struct Chunk {
  ChunkKind kind = ChunkKind::kHead;
  std::string content;
};

/// The one chunk that a message is; nothing if it is damaged or more than that.
std::optional<Chunk> chunk_in(std::string_view message);

/// Reads chunks one after the other.
class ChunkReader {
 public:
  /// Reads at most `size` bytes and returns how many; fewer only at the end.
  using Source = std::function<std::size_t(void* to, std::size_t size)>;

  /// `size_bytes`: of all that the source has, with the `start_bytes` that were read before.
  ChunkReader(Source source, std::uint64_t size_bytes, std::uint64_t start_bytes = 0)
      : source_(std::move(source)), size_bytes_(size_bytes), at_bytes_(start_bytes) {}

  /// The next good chunk; false at the end. Those that are damaged are counted.
  bool next(Chunk& chunk);
  /// True if the bytes before the last chunk were damaged, or the chunk before it.
  bool skipped() const { return skipped_; }
  /// "3 of 20 frames are damaged, the first at byte 4711; " and what else is wrong; or empty.
  std::string damage() const;

 private:
  struct Count {
    std::uint64_t good = 0, damaged = 0, first_damaged_at_bytes = 0;
  };
  bool read(void* to, std::size_t size);
  bool read_header(ChunkHeader& header);

  Source source_;
  std::uint64_t size_bytes_, at_bytes_;
  std::map<ChunkKind, Count> counts_;
  std::uint64_t lost_bytes_ = 0, first_lost_at_bytes_ = 0;
  std::string cut_off_;  // how the last chunk ends too early
  bool skipped_ = false;
};

}  // namespace tact::firmware::protocol
