// SPDX-License-Identifier: Apache-2.0
// mcap_writer.h - a file of timed messages in MCAP, version 0: https://mcap.dev/spec
//
//     magic, header, metadata, chunks each with their message indexes, data end
//     summary: schemas, channels, chunk indexes, metadata index, statistics; their places; footer
//
// Chunks are not compressed. Each has its CRC-32, and so have the data section and the summary
// (polynomial 0x04C11DB7, as zlib). All or nothing, as model/io/file_writer.h says.
#pragma once

#include <boost/crc.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/io/file_writer.h"
#include "model/result.h"
#include "tools/mcap/bytes.h"

namespace tact::tools::mcap {

/// How the bytes of a message are read.
struct Schema {
  std::string_view name;
  std::string_view encoding;
  std::string_view text;
  std::string_view message_encoding;
};

using Pairs = std::vector<std::pair<std::string, std::string>>;

class McapWriter {
 public:
  /// Error: PATH, what is wrong and the cure.
  static model::Result<McapWriter> create(const std::string& path, std::string_view profile,
                                          std::string_view library);

  /// Before the first message.
  std::optional<model::Error> add_metadata(std::string_view name, const Pairs& pairs);
  /// Of messages that follow; its number. Schemas of one name are one schema.
  std::uint16_t add_channel(const std::string& topic, const Schema& schema);
  std::optional<model::Error> put(std::uint16_t channel, std::uint64_t time_ns,
                                  std::string_view message);
  std::optional<model::Error> finish();

  std::uint64_t messages() const { return total_.messages; }

 private:
  struct Span {  // of messages, in ns
    std::uint64_t messages = 0, first_ns = 0, last_ns = 0;
    void add(std::uint64_t time_ns);
  };
  struct Place {
    std::uint64_t start = 0, bytes = 0;
  };
  explicit McapWriter(model::io::FileWriter file) : file_(std::move(file)) {}

  std::optional<model::Error> write(std::string_view bytes);
  std::optional<model::Error> end_chunk();
  void index_chunk(const Place& chunk, const std::map<std::uint16_t, std::uint64_t>& indexes,
                   std::uint64_t index_bytes, std::uint64_t record_bytes);
  std::string statistics() const;
  std::string summary(std::uint64_t start) const;

  model::io::FileWriter file_;
  std::uint64_t written_ = 0;
  boost::crc_32_type data_crc_;  // of all bytes so far
  Bytes chunk_;
  Span chunk_span_, total_;
  std::map<std::uint16_t, Bytes> chunk_index_;       // by channel: time and place of each message
  std::map<std::uint16_t, std::uint32_t> sequence_;  // messages so far
  Bytes schemas_, channels_, chunk_indexes_, metadata_indexes_;
  std::map<std::string, std::uint16_t, std::less<>> schema_of_;
  std::uint32_t chunks_ = 0, metadata_ = 0;
};

}  // namespace tact::tools::mcap
