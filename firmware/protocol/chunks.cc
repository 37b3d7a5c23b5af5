// SPDX-License-Identifier: Apache-2.0
#include "firmware/protocol/chunks.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cstddef>
#include <cstring>

namespace tact::firmware::protocol {
namespace {

std::uint32_t own_crc_of(const ChunkHeader& header) {
  return crc_of({reinterpret_cast<const char*>(&header), offsetof(ChunkHeader, header_crc)});
}

const char* name_of(ChunkKind kind) {
  switch (kind) {
    case ChunkKind::kHead:
      return "heads";
    case ChunkKind::kMeshes:
      return "meshes";
    case ChunkKind::kTick:
      return "ticks";
    case ChunkKind::kFrame:
      return "frames";
    case ChunkKind::kOperator:
      return "operators";
    case ChunkKind::kVariant:
      return "changes of the law";
  }
  return "unknown parts";
}

}  // namespace

std::uint32_t crc_of(std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

std::string chunk_of(ChunkKind kind, std::string_view content) {
  ChunkHeader header{.kind = kind,
                     .content_bytes = static_cast<std::uint32_t>(content.size()),
                     .content_crc = crc_of(content)};
  header.header_crc = own_crc_of(header);
  std::string out(reinterpret_cast<const char*>(&header), sizeof header);
  return out += content;
}

std::optional<Chunk> chunk_in(std::string_view message) {
  ChunkHeader header;
  if (message.size() < sizeof header) return std::nullopt;
  std::memcpy(&header, message.data(), sizeof header);
  const std::string_view content = message.substr(sizeof header);
  if (own_crc_of(header) != header.header_crc || header.content_bytes != content.size() ||
      header.content_crc != crc_of(content))
    return std::nullopt;
  return Chunk{.kind = header.kind, .content = std::string(content)};
}

bool ChunkReader::read(void* to, std::size_t size) {
  const std::size_t got = source_(to, size);
  at_bytes_ += got;
  return got == size;
}

/// The next header whose CRC is right; bytes before it are counted as lost.
bool ChunkReader::read_header(ChunkHeader& header) {
  const std::uint64_t start_bytes = at_bytes_;
  std::uint64_t lost_bytes = 0;
  bool is_whole = read(&header, sizeof header);
  if (!is_whole && at_bytes_ > start_bytes)
    cut_off_ = fmt::format("the file is cut off at byte {}; ", at_bytes_);
  while (is_whole && own_crc_of(header) != header.header_crc) {
    ++lost_bytes;
    char* const bytes = reinterpret_cast<char*>(&header);
    std::memmove(bytes, bytes + 1, sizeof header - 1);
    is_whole = read(bytes + sizeof header - 1, 1);
    if (!is_whole) lost_bytes += sizeof header - 1;
  }
  if (lost_bytes > 0) {
    if (lost_bytes_ == 0) first_lost_at_bytes_ = start_bytes;
    lost_bytes_ += lost_bytes;
    skipped_ = true;
  }
  return is_whole;
}

bool ChunkReader::next(Chunk& chunk) {
  skipped_ = false;
  for (;;) {
    ChunkHeader header;
    if (!read_header(header)) return false;
    const std::uint64_t start_bytes = at_bytes_ - sizeof header;
    // Compared before allocating, because a length in a file may be wrong.
    const std::uint64_t left_bytes = size_bytes_ - std::min(size_bytes_, at_bytes_);
    chunk.kind = header.kind;
    chunk.content.resize(std::min<std::uint64_t>(header.content_bytes, left_bytes));
    if (!read(chunk.content.data(), chunk.content.size()) ||
        chunk.content.size() < header.content_bytes) {
      cut_off_ = fmt::format("the file is cut off at byte {}, within one of its {}; ", at_bytes_,
                             name_of(header.kind));
      return false;
    }
    Count& count = counts_[header.kind];
    if (crc_of(chunk.content) == header.content_crc) {
      ++count.good;
      return true;
    }
    if (count.damaged++ == 0) count.first_damaged_at_bytes = start_bytes;
    skipped_ = true;
  }
}

std::string ChunkReader::damage() const {
  std::string out;
  for (const auto& [kind, count] : counts_)
    if (count.damaged > 0)
      out += fmt::format("{} of {} {} are damaged, the first at byte {}; ", count.damaged,
                         count.good + count.damaged, name_of(kind), count.first_damaged_at_bytes);
  if (lost_bytes_ > 0)
    out += fmt::format("{} bytes belong to no whole part, the first at byte {}; ", lost_bytes_,
                       first_lost_at_bytes_);
  return out + cut_off_;
}

}  // namespace tact::firmware::protocol
