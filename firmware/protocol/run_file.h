// SPDX-License-Identifier: Apache-2.0
// run_file.h - the one file format: tick log, recording and black box are chunks (chunks.h) in a
// sealed file (model/io/seal.h), which begins with eight letters and the head.
//
//     tick log   head, ticks                        tactd --record
//     recording  head, meshes, frames, operators    tact-view --record
//     black box  head, meshes, ticks, frames        tactd, at a fault
//
// The head is JSON: {"version": 1, "run": a RunHeader, "records": {name: {"kind", "fields"}}}. The
// memory file of the telemetry socket has the same letters, head and meshes. Each message is one
// chunk. The memory file followed by the messages has the format of a recording.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

#include "firmware/protocol/chunks.h"
#include "firmware/protocol/frame.h"
#include "firmware/protocol/record_fields.h"
#include "firmware/protocol/run_header.h"
#include "model/io/seal.h"
#include "model/result.h"

namespace tact::firmware::protocol {

inline constexpr std::string_view kMagic = "tactrun\n";
/// The first message of a telemetry socket that has as many clients as it takes.
inline constexpr std::string_view kFull = "tactfull\n";
inline constexpr int kVersion = 1;  // of the format; a field more or less does not change it

/// A kind of record in a file.
struct RecordSchema {
  ChunkKind kind;
  const char* name;
  FieldTable fields;
};
template <typename Record>
RecordSchema schema_of(FieldTable fields = Record::fields()) {
  return {Record::kKind, Record::kName, fields};
}

/// The bytes before the first record; without meshes a tick log's.
std::string start_of_run(const RunHeader& header, std::span<const std::byte> meshes,
                         std::initializer_list<RecordSchema> records);

template <typename Record>
std::string chunk_of(const Record& record, FieldTable fields = Record::fields()) {
  std::string content;
  content.reserve(sizeof record);
  pack(fields, &record, content);
  return chunk_of(Record::kKind, content);
}

/// Chosen: some two hours at 1 kHz.
inline constexpr std::uint64_t kMaxRecord_bytes = std::uint64_t{4} << 30;

/// A tick log as it grows. Writes in an ordinary thread. After a loss nothing more is written: a
/// log with a gap cannot be replayed. At `most_bytes` the file is sealed and becomes PATH.old, in
/// place of an older one, and a new one begins: the newest is kept.
class RunWriter {
 public:
  static model::Result<RunWriter> create(const std::string& path, const std::string& start,
                                         std::uint64_t most_bytes = UINT64_MAX);
  void add(const std::string& bytes);
  void flush();
  /// The error after which nothing more is written, if any.
  const std::optional<model::Error>& error() const { return error_; }
  /// What has been lost or dropped, once each, in words for a person.
  std::optional<std::string> news() { return std::exchange(news_, std::nullopt); }
  /// Closes the file. After a loss it is not sealed, so readers report it as unfinished.
  std::optional<model::Error> close();

 private:
  RunWriter(model::io::SealedWriter file, std::string path, std::string start,
            std::uint64_t most_bytes)
      : path_(std::move(path)),
        start_(std::move(start)),
        most_bytes_(most_bytes),
        file_(std::move(file)) {}
  void begin_again();
  void keep(const std::optional<model::Error>& error);

  std::string path_, start_;
  std::uint64_t most_bytes_, bytes_ = 0;  // of this file, without its start
  std::optional<std::string> news_;
  std::optional<model::io::SealedWriter> file_;
  std::optional<model::Error> error_;
};

/// Reads a file, or the bytes of the memory file.
class RunReader {
 public:
  static model::Result<RunReader> open(const std::string& path, std::string_view remedy);
  static model::Result<RunReader> of_bytes(std::string bytes);

  const RunHeader& header() const { return header_; }
  /// All fields are missing() where the file has no records of that kind.
  template <typename Record>
  model::Result<Unpacker> unpacker() const {
    return make_unpacker(schema_of<Record>());
  }
  /// The next good chunk; false at the end. Those that are damaged are skipped.
  bool next(Chunk& chunk) { return chunks_.next(chunk); }
  bool skipped() const { return chunks_.skipped(); }
  /// Call after the last chunk: empty, or the damage, with "; " at its end.
  std::string damage();

 private:
  RunReader(ChunkReader::Source source, std::uint64_t size_bytes,
            std::unique_ptr<model::io::SealedFile> file)
      : file_(std::move(file)), chunks_(std::move(source), size_bytes, kMagic.size()) {}
  std::optional<model::Error> read_head();
  model::Result<Unpacker> make_unpacker(const RecordSchema& type) const;

  std::unique_ptr<model::io::SealedFile> file_;  // null: of_bytes
  ChunkReader chunks_;
  RunHeader header_;
  std::shared_ptr<const nlohmann::json> records_;
};

}  // namespace tact::firmware::protocol
