// SPDX-License-Identifier: Apache-2.0
#include "firmware/protocol/run_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "model/io/json.h"

namespace tact::firmware::protocol {
namespace {

using model::Error;
using model::Result;
using nlohmann::json;

/// Why these are not the first bytes of a run.
std::optional<Error> check_magic(std::string_view magic) {
  if (magic == kMagic) return std::nullopt;
  if (magic.starts_with("tactlog") || magic.starts_with("tactrec"))
    return Error{
        "was written by tact before its files had version 1; record it again, or open it with the "
        "build that made it"};
  return Error{
      "is no file of tact; name one that tactd --record, tact-view --record or a black box wrote"};
}

}  // namespace

std::string start_of_run(const RunHeader& header, std::span<const std::byte> meshes,
                         std::initializer_list<RecordSchema> records) {
  json head{{"version", kVersion}, {"run", json_of(header)}, {"records", json::object()}};
  for (const RecordSchema& type : records)
    head["records"][type.name] = {{"kind", type.kind}, {"fields", json_of(type.fields)}};
  std::string out(kMagic);
  out += chunk_of(ChunkKind::kHead, model::io::text_of(head));
  if (!meshes.empty())
    out +=
        chunk_of(ChunkKind::kMeshes, {reinterpret_cast<const char*>(meshes.data()), meshes.size()});
  return out;
}

Result<RunWriter> RunWriter::create(const std::string& path, const std::string& start,
                                    std::uint64_t most_bytes) {
  auto file = model::io::SealedWriter::create(path);
  if (!file) return file.error();
  if (auto error = file->put(start)) return *error;
  // At once: what cannot be written at all is refused before the run.
  if (auto error = file->flush()) return *error;
  return RunWriter(std::move(*file), path, start, most_bytes);
}

void RunWriter::add(const std::string& bytes) {
  if (!error_ && bytes_ + bytes.size() > most_bytes_) begin_again();
  bytes_ += bytes.size();
  if (!error_) keep(file_->put(bytes));
}

void RunWriter::begin_again() {
  const std::string old = path_ + ".old";
  if (const auto error = file_->finish()) return keep(error);
  if (rename(path_.c_str(), old.c_str()) != 0)
    return keep(Error{fmt::format("{}: cannot be renamed: {}", path_, std::strerror(errno))});
  auto next = create(path_, start_, most_bytes_);
  if (!next) return keep(next.error());
  file_ = std::move(next->file_);
  bytes_ = 0;
  news_ = fmt::format(
      "{}: {} MB are written, and it begins again; {} keeps them, what came before "
      "is dropped",
      path_, most_bytes_ >> 20, old);
}

void RunWriter::flush() {
  if (file_ && !error_) keep(file_->flush());
}

void RunWriter::keep(const std::optional<Error>& error) {
  if (!error) return;
  error_ = Error{error->message + "; what was written before is kept"};
  news_ = error_->message + "; the run goes on without its record";
}

std::optional<Error> RunWriter::close() {
  if (file_ && !error_) error_ = file_->finish();
  file_.reset();
  return error_;
}

Result<RunReader> RunReader::open(const std::string& path, std::string_view remedy) {
  auto opened = model::io::SealedFile::open(path, remedy);
  if (!opened) return opened.error();
  auto file = std::make_unique<model::io::SealedFile>(std::move(*opened));
  model::io::SealedFile* const in = file.get();
  RunReader reader([in](void* to, std::size_t size) { return in->read(to, size); },
                   in->size_bytes(), std::move(file));
  std::string magic(kMagic.size(), '\0');
  magic.resize(in->read(magic.data(), magic.size()));
  if (auto error = check_magic(magic)) return Error{path + ": " + error->message};
  if (auto error = reader.read_head()) return Error{path + ": " + error->message};
  return reader;
}

Result<RunReader> RunReader::of_bytes(std::string bytes) {
  if (auto error = check_magic(std::string_view(bytes).substr(0, kMagic.size()))) return *error;
  const std::uint64_t size_bytes = bytes.size();
  auto source = [all = std::move(bytes), at = kMagic.size()](void* to, std::size_t size) mutable {
    const std::size_t got = std::min(size, all.size() - at);
    std::memcpy(to, all.data() + at, got);
    at += got;
    return got;
  };
  RunReader reader(std::move(source), size_bytes, nullptr);
  if (auto error = reader.read_head()) return *error;
  return reader;
}

std::optional<Error> RunReader::read_head() {
  Error damaged{"its head is damaged, so nothing of it can be used; record it again"};
  Chunk chunk;
  if (!next(chunk) || chunk.kind != ChunkKind::kHead || skipped()) return damaged;
  auto head = model::io::parse_json(chunk.content, "its head");
  if (!head || !head->is_object()) return damaged;
  const json version = head->value("version", json());
  if (version != kVersion)
    return Error{
        fmt::format("has version {}, this program reads version {}; open it with the "
                    "build that made it",
                    model::io::text_of(version), kVersion)};
  auto header = header_of(head->value("run", json()));
  if (!header) return header.error();
  header_ = std::move(*header);
  records_ = std::make_shared<const json>(head->value("records", json::object()));
  return std::nullopt;
}

Result<Unpacker> RunReader::make_unpacker(const RecordSchema& type) const {
  const json record = records_->is_object() ? records_->value(type.name, json()) : json();
  return Unpacker::make(record.is_object() ? record.value("fields", json::array()) : json::array(),
                        type.fields);
}

std::string RunReader::damage() {
  std::string out = chunks_.damage();
  if (file_ == nullptr) return out;
  if (const std::string damage = file_->damage(); !damage.empty()) out += damage + "; ";
  return out;
}

}  // namespace tact::firmware::protocol
