// SPDX-License-Identifier: Apache-2.0
#include "tools/mcap/mcap_writer.h"

#include <algorithm>
#include <iterator>

namespace tact::tools::mcap {
namespace {

using model::Error;
using model::Result;

constexpr std::string_view kMagic = "\x89MCAP0\r\n";
constexpr std::size_t kChunkBytes = 1 << 20;  // a reader seeks by chunks

// Op codes of the specification; attachments are not written.
enum class Op : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0b,
  kMetadata = 0x0c,
  kMetadataIndex = 0x0d,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

std::string record(Op op, const Bytes& content) {
  return Bytes()
      .put(static_cast<std::uint8_t>(op))
      .put(std::uint64_t{content.size()})
      .raw(content.str())
      .str();
}

std::uint32_t crc_of(std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

Bytes map_of(const std::map<std::uint16_t, std::uint64_t>& numbers) {
  Bytes out;
  // MCAP's maps begin with their bytes: u16 and u64 are ten for each pair.
  out.put(static_cast<std::uint32_t>(numbers.size() * 10));
  for (const auto& [key, value] : numbers) out.put(key).put(value);
  return out;
}

}  // namespace

void McapWriter::Span::add(std::uint64_t time_ns) {
  first_ns = messages == 0 ? time_ns : std::min(first_ns, time_ns);
  last_ns = std::max(last_ns, time_ns);
  ++messages;
}

Result<McapWriter> McapWriter::create(const std::string& path, std::string_view profile,
                                      std::string_view library) {
  const std::string head =
      std::string(kMagic) + record(Op::kHeader, Bytes().text(profile).text(library));
  auto file = model::io::FileWriter::replace(path, head);
  if (!file) return file.error();
  McapWriter writer(std::move(*file));
  if (const auto error = writer.write(head)) return *error;
  return writer;
}

std::optional<Error> McapWriter::write(std::string_view bytes) {
  data_crc_.process_bytes(bytes.data(), bytes.size());
  written_ += bytes.size();
  return file_.put(bytes);
}

std::optional<Error> McapWriter::add_metadata(std::string_view name, const Pairs& pairs) {
  Bytes map;
  for (const auto& [key, value] : pairs) map.text(key).text(value);
  const std::string whole = record(Op::kMetadata, Bytes().text(name).text(map.str()));
  metadata_indexes_.raw(record(Op::kMetadataIndex,
                               Bytes().put(written_).put(std::uint64_t{whole.size()}).text(name)));
  ++metadata_;
  return write(whole);
}

std::uint16_t McapWriter::add_channel(const std::string& topic, const Schema& schema) {
  // From 1: schema 0 means "none".
  const auto next = static_cast<std::uint16_t>(schema_of_.size() + 1);
  const auto [found, is_new] = schema_of_.try_emplace(std::string(schema.name), next);
  if (is_new) {
    const std::string whole = record(
        Op::kSchema, Bytes().put(next).text(schema.name).text(schema.encoding).text(schema.text));
    // In the chunk, for who reads from the front, and in the summary, for who seeks.
    schemas_.raw(whole);
    chunk_.raw(whole);
  }
  const auto channel = static_cast<std::uint16_t>(sequence_.size());
  const Bytes metadata = Bytes().text("offered_qos_profiles").text("");  // profile ros2 asks for it
  const std::string whole = record(Op::kChannel, Bytes()
                                                     .put(channel)
                                                     .put(found->second)
                                                     .text(topic)
                                                     .text(schema.message_encoding)
                                                     .text(metadata.str()));
  channels_.raw(whole);
  chunk_.raw(whole);
  sequence_[channel] = 0;
  return channel;
}

std::optional<Error> McapWriter::put(std::uint16_t channel, std::uint64_t time_ns,
                                     std::string_view message) {
  // Where the message's record begins within the chunk.
  chunk_index_[channel].put(time_ns).put(std::uint64_t{chunk_.size()});
  chunk_.raw(record(
      Op::kMessage,
      Bytes().put(channel).put(sequence_[channel]++).put(time_ns).put(time_ns).raw(message)));
  chunk_span_.add(time_ns);
  total_.add(time_ns);
  return chunk_.size() < kChunkBytes ? std::nullopt : end_chunk();
}

std::optional<Error> McapWriter::end_chunk() {
  const Place chunk{.start = written_, .bytes = 0};
  const std::string whole = record(Op::kChunk, Bytes()
                                                   .put(chunk_span_.first_ns)
                                                   .put(chunk_span_.last_ns)
                                                   .put(std::uint64_t{chunk_.size()})
                                                   .put(crc_of(chunk_.str()))
                                                   .text("")  // no compression
                                                   .put(std::uint64_t{chunk_.size()})
                                                   .raw(chunk_.str()));
  std::string after;
  std::map<std::uint16_t, std::uint64_t> indexes;
  for (const auto& [channel, places] : chunk_index_) {
    // Places count from the start of the file; the indexes stand right behind their chunk.
    indexes[channel] = chunk.start + whole.size() + after.size();
    after += record(Op::kMessageIndex, Bytes().put(channel).text(places.str()));
  }
  index_chunk({.start = chunk.start, .bytes = whole.size()}, indexes, after.size(), chunk_.size());
  chunk_.clear();
  chunk_index_.clear();
  chunk_span_ = {};
  if (const auto error = write(whole)) return error;
  return write(after);
}

void McapWriter::index_chunk(const Place& chunk,
                             const std::map<std::uint16_t, std::uint64_t>& indexes,
                             std::uint64_t index_bytes, std::uint64_t record_bytes) {
  ++chunks_;
  chunk_indexes_.raw(record(Op::kChunkIndex, Bytes()
                                                 .put(chunk_span_.first_ns)
                                                 .put(chunk_span_.last_ns)
                                                 .put(chunk.start)
                                                 .put(chunk.bytes)
                                                 .raw(map_of(indexes).str())
                                                 .put(index_bytes)
                                                 .text("")  // no compression
                                                 .put(record_bytes)
                                                 .put(record_bytes)));
}

std::string McapWriter::statistics() const {
  const std::map<std::uint16_t, std::uint64_t> counts(sequence_.begin(), sequence_.end());
  return record(Op::kStatistics, Bytes()
                                     .put(total_.messages)
                                     .put(static_cast<std::uint16_t>(schema_of_.size()))
                                     .put(static_cast<std::uint32_t>(sequence_.size()))
                                     .put(std::uint32_t{0})  // attachments
                                     .put(metadata_)
                                     .put(chunks_)
                                     .put(total_.first_ns)
                                     .put(total_.last_ns)
                                     .raw(map_of(counts).str()));
}

/// From `start` to the end of the file. Groups by kind, then where each group is, then the footer.
std::string McapWriter::summary(std::uint64_t start) const {
  const std::pair<Op, std::string> groups[] = {{Op::kSchema, schemas_.str()},
                                               {Op::kChannel, channels_.str()},
                                               {Op::kChunkIndex, chunk_indexes_.str()},
                                               {Op::kMetadataIndex, metadata_indexes_.str()},
                                               {Op::kStatistics, statistics()}};
  std::string out, offsets;
  for (const auto& [op, group] : groups) {
    if (group.empty()) continue;
    offsets += record(Op::kSummaryOffset, Bytes()
                                              .put(static_cast<std::uint8_t>(op))
                                              .put(start + out.size())
                                              .put(std::uint64_t{group.size()}));
    out += group;
  }
  const std::uint64_t offsets_start = start + out.size();
  out += offsets;
  // The sum goes from the start of the summary to the last field before the sum itself.
  out += Bytes()
             .put(static_cast<std::uint8_t>(Op::kFooter))
             .put(std::uint64_t{8 + 8 + 4})
             .put(start)
             .put(offsets_start)
             .str();
  out += Bytes().put(crc_of(out)).str();
  return out += kMagic;
}

std::optional<Error> McapWriter::finish() {
  if (chunk_.size() > 0)
    if (const auto error = end_chunk()) return error;
  if (const auto error = write(record(Op::kDataEnd, Bytes().put(data_crc_.checksum()))))
    return error;
  if (const auto error = file_.put(summary(written_))) return error;
  return file_.finish();
}

}  // namespace tact::tools::mcap
