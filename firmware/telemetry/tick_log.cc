// SPDX-License-Identifier: Apache-2.0
#include "firmware/telemetry/tick_log.h"

#include <fmt/format.h>

#include <cstring>
#include <sstream>
#include <type_traits>

namespace tact::firmware::telemetry {

using model::Error;
using model::Result;

static_assert(std::is_trivially_copyable_v<LoggedTick>);
// All but header_crc and pad, its last fields.
constexpr std::size_t kSummedBytes = sizeof(LogHeader) - 2 * sizeof(std::uint32_t);

bool LogHeader::keep_overrides(const std::vector<std::string>& of_run) {
  std::string text;
  for (const std::string& one : of_run) text += one + '\n';
  // The field needs one byte for the terminating zero.
  if (text.size() >= sizeof overrides) return false;
  text.copy(overrides, text.size());
  return true;
}

std::vector<std::string> LogHeader::overrides_of_run() const {
  std::vector<std::string> out;
  std::istringstream lines(overrides);
  for (std::string one; std::getline(lines, one);) out.push_back(one);
  return out;
}

Result<TickLogWriter> TickLogWriter::create(const std::string& path, const LogHeader& header) {
  auto file = model::io::SealedWriter::create(path);
  if (!file) return file.error();
  LogHeader full = header;
  std::memcpy(full.magic, kLogMagic, sizeof full.magic);
  full.header_bytes = sizeof(LogHeader);
  // The size detects a build of the same version whose structs differ.
  full.tick_bytes = sizeof(LogRecord);
  full.header_crc = crc_of(&full, kSummedBytes);
  if (auto error = file->put({reinterpret_cast<const char*>(&full), sizeof full})) return *error;
  return TickLogWriter(std::move(*file), header.non_rt != 0);
}

LoggedTick LoggedTick::of(const loop::TickRecord& record, bool non_rt) {
  return {.tick = record.tick,
          .non_rt = static_cast<std::uint8_t>(non_rt ? 1 : 0),
          .due_ns = record.due_ns,
          .margin_ns = record.margin_ns,
          .phase_ns = record.phase_ns,
          .input = record.input,
          .output = record.output};
}

void TickLogWriter::add(const LoggedTick& tick) {
  // A log with a gap cannot be replayed: after the first loss nothing more is written.
  if (trouble_) return;
  LogRecord record;
  std::memcpy(&record.tick, &tick, sizeof tick);  // with its padding, which the CRC covers
  record.crc = crc_of(&record.tick, sizeof record.tick);
  put(&record, sizeof record, fmt::format("tick {}", tick.tick));
}

void TickLogWriter::append(const std::string& bytes) {
  if (!trouble_) put(bytes.data(), bytes.size(), "its pictures");
}

void TickLogWriter::put(const void* bytes, std::size_t size, const std::string& where) {
  if (const auto error = file_->put({static_cast<const char*>(bytes), size}))
    trouble_ = Error{fmt::format("{}; what came before {} is kept", error->message, where)};
}

std::optional<Error> TickLogWriter::close() {
  // After a loss the file is not sealed, so readers report it as unfinished.
  if (file_ && !trouble_) trouble_ = file_->finish();
  file_.reset();
  return trouble_;
}

Result<TickLogReader> TickLogReader::open(const std::string& path) {
  auto file = model::io::SealedFile::open(path, "name a file that tactd --record wrote");
  if (!file) return file.error();
  LogHeader header;
  const std::size_t read = file->read(&header, sizeof header);
  TickLogReader reader(std::move(*file), header);
  // In the order of precedence: another file, another version, damage, another build.
  constexpr std::size_t kVersionAt = sizeof header.magic - 1;
  if (read < sizeof(LogStart) || std::memcmp(header.magic, kLogMagic, kVersionAt) != 0)
    return Error{path + ": is no tick log; name a file that tactd --record wrote"};
  if (header.magic[kVersionAt] != kLogMagic[kVersionAt])
    return Error{fmt::format(
        "{}: is a tick log of version {}, this tactd reads version {}; record it again, or replay "
        "it with the build that recorded it",
        path, header.magic[kVersionAt], kLogMagic[kVersionAt])};
  if (read < sizeof header || header.header_crc != crc_of(&header, kSummedBytes))
    return Error{path +
                 ": its header is damaged, so none of its ticks can be used; record it again"};
  if (header.tick_bytes != sizeof(LogRecord) || header.header_bytes != sizeof(LogHeader))
    return Error{path + ": was written by another version of tactd; replay it with that one"};
  // A correct CRC does not prove that texts are terminated: any program may have written the file.
  reader.header_.scene_hash[sizeof header.scene_hash - 1] = '\0';
  reader.header_.overrides[sizeof header.overrides - 1] = '\0';
  return reader;
}

bool TickLogReader::next(LoggedTick& tick) {
  while (header_.ticks == 0 || read_ < header_.ticks) {
    LogRecord record;
    const std::size_t bytes = file_.read(&record, sizeof record);
    // With ticks == 0 the records end with the file. A partial record is always damage.
    torn_ = torn_ || (bytes < sizeof record && (bytes > 0 || header_.ticks != 0));
    if (bytes < sizeof record) return false;
    ++read_;
    if (record.crc == crc_of(&record.tick, sizeof record.tick)) {
      ++good_;
      tick = record.tick;
      return true;
    }
    if (read_ - good_ == 1) first_damaged_ = read_;
  }
  return false;
}

std::string TickLogReader::damage() {
  std::string out;
  if (read_ > good_)
    out = fmt::format("{} of {} ticks are damaged, the first is number {} in the file; ",
                      read_ - good_, read_, first_damaged_);
  if (torn_) out += fmt::format("the file is cut off in tick number {}; ", read_ + 1);
  if (const std::string trouble = file_.trouble(); !trouble.empty()) out += trouble + "; ";
  return out.empty() ? out : out + fmt::format("{} good ticks were read", good_);
}

}  // namespace tact::firmware::telemetry
