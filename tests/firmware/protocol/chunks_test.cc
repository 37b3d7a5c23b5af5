// SPDX-License-Identifier: Apache-2.0
// Chunks with damage anywhere: what is whole comes back, the rest is counted.
#include "firmware/protocol/chunks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "firmware/protocol/logged_tick.h"
#include "firmware/protocol/run_file.h"

namespace tact::firmware::protocol::chunks_test {

ChunkReader reader_of(std::string bytes) {
  const std::size_t size_bytes = bytes.size();
  auto source = [all = std::move(bytes), at = std::size_t{0}](void* to, std::size_t size) mutable {
    const std::size_t got = std::min(size, all.size() - at);
    std::memcpy(to, all.data() + at, got);
    at += got;
    return got;
  };
  return {std::move(source), size_bytes};
}

/// Chunk i has the content i, of a length of its own.
std::string content_of(std::size_t i) { return std::string(5 + i % 7, static_cast<char>('a' + i)); }

struct Read {
  std::vector<std::string> contents;
  std::string damage;
};

Read read_all(const std::string& bytes) {
  ChunkReader reader = reader_of(bytes);
  Read out;
  for (Chunk chunk; reader.next(chunk);) out.contents.push_back(chunk.content);
  out.damage = reader.damage();
  return out;
}

TEST(Chunks, AByteFlippedAnywhereLosesItsChunkAlone) {
  std::string bytes;
  std::vector<std::string> contents;
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < 12; ++i) {
    contents.push_back(content_of(i));
    starts.push_back(bytes.size());
    bytes += chunk_of(i % 2 == 0 ? ChunkKind::kTick : ChunkKind::kFrame, contents.back());
  }
  EXPECT_EQ(read_all(bytes).contents, contents);
  EXPECT_EQ(read_all(bytes).damage, "");
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    const std::size_t hit = static_cast<std::size_t>(
        std::upper_bound(starts.begin(), starts.end(), at) - starts.begin() - 1);
    std::vector<std::string> expected = contents;
    expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(hit));
    const Read read = read_all(damaged);
    ASSERT_EQ(read.contents, expected) << at;
    EXPECT_NE(read.damage.find(std::to_string(starts[hit])), std::string::npos) << read.damage;
  }
}

TEST(Chunks, TruncationKeepsEveryWholeChunkBeforeTheCut) {
  std::string bytes;
  std::vector<std::size_t> ends;
  for (std::size_t i = 0; i < 6; ++i) {
    bytes += chunk_of(ChunkKind::kTick, content_of(i));
    ends.push_back(bytes.size());
  }
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const Read read = read_all(bytes.substr(0, size));
    const auto whole = std::upper_bound(ends.begin(), ends.end(), size) - ends.begin();
    ASSERT_EQ(read.contents.size(), static_cast<std::size_t>(whole)) << size;
    const bool is_at_an_end = size == 0 || std::ranges::count(ends, size) > 0;
    EXPECT_EQ(read.damage.empty(), is_at_an_end) << size << ": " << read.damage;
  }
}

TEST(Chunks, ALengthBeyondTheFileAllocatesNoMoreThanTheFileHas) {
  ChunkHeader header{.kind = ChunkKind::kTick, .content_bytes = UINT32_MAX};
  header.header_crc = crc_of({reinterpret_cast<const char*>(&header), 12});
  std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
  ChunkReader reader = reader_of(bytes += "abc");
  Chunk chunk;
  EXPECT_FALSE(reader.next(chunk));
  EXPECT_LE(chunk.content.capacity(), 100u);
  EXPECT_NE(reader.damage().find("cut off at byte 19"), std::string::npos) << reader.damage();
}

TEST(Chunks, AMessageIsOneChunk) {
  const std::string message = chunk_of(ChunkKind::kFrame, "abc");
  EXPECT_EQ(chunk_in(message)->content, "abc");
  EXPECT_FALSE(chunk_in(message + "x"));
  EXPECT_FALSE(chunk_in(message.substr(1)));
  EXPECT_FALSE(chunk_in(""));
}

TEST(Chunks, RandomBytesAreNoRun) {
  std::mt19937 random(2);
  const std::string start = start_of_run({}, {}, {schema_of<LoggedTick>()});
  for (int i = 0; i < 2000; ++i) {
    std::string bytes = i % 2 == 0 ? start : std::string(kMagic);
    const std::size_t length = random() % 200;
    for (std::size_t k = 0; k < length; ++k)
      if (i % 2 == 0)
        bytes[kMagic.size() + random() % (bytes.size() - kMagic.size())] =
            static_cast<char>(random());
      else
        bytes += static_cast<char>(random());
    // With no byte changed it is one; else it says why not.
    const auto run = RunReader::of_bytes(bytes);
    if (bytes != start) {
      ASSERT_FALSE(run);
      EXPECT_FALSE(run.error().message.empty());
    }
  }
}

TEST(Chunks, AHeadOfALaterVersionIsRefusedWithItsNumber) {
  const std::string bytes =
      std::string(kMagic) +
      chunk_of(ChunkKind::kHead, R"({"version": 2, "run": {}, "records": {}})");
  const auto run = RunReader::of_bytes(bytes);
  ASSERT_FALSE(run);
  EXPECT_NE(run.error().message.find("has version 2, this program reads version 1"),
            std::string::npos)
      << run.error().message;
  for (const char* head : {"[]", "7", "{\"version\": 1, \"run\": {\"rate_Hz\": \"fast\"}}",
                           "{\"version\": 1}", "{\"version\": 1, \"run\": {}, \"records\": [1]}"})
    static_cast<void>(RunReader::of_bytes(std::string(kMagic) + chunk_of(ChunkKind::kHead, head)));
}

}  // namespace tact::firmware::protocol::chunks_test
