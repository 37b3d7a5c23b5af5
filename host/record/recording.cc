// SPDX-License-Identifier: Apache-2.0
#include "host/record/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "host/record/operator_record.h"

namespace tact::host::record {
namespace {

using firmware::telemetry::crc_of;
using model::Error;
using model::Result;

/// The data before the first frame.
struct Setup {
  Hello hello;
  MeshBytes mesh;
  std::size_t operator_bytes = 0;  // after each frame
};

using model::io::SealedFile;

template <typename T>
bool read(SealedFile& in, T& value) {
  return in.read(&value, sizeof value) == sizeof value;
}

/// The first bytes of a recording or a tick log.
using Magic = std::array<char, sizeof kRecordingMagic>;

/// A black box contains a recording after its ticks: seeks to it and reads its magic. Returns its
/// byte offset; the error says why there is none.
Result<std::uint64_t> skip_ticks(SealedFile& in, Magic& magic) {
  const std::uint64_t file_bytes = in.size_bytes();
  firmware::telemetry::LogStart log;
  constexpr std::size_t kVersionAt = sizeof log.magic - 1;
  const bool is_log =
      read(in, magic) && std::memcmp(magic.data(), firmware::telemetry::kLogMagic, kVersionAt) == 0;
  if (!is_log) return std::uint64_t{0};
  std::memcpy(log.magic, magic.data(), sizeof log.magic);
  if (log.magic[kVersionAt] != firmware::telemetry::kLogMagic[kVersionAt])
    return Error{fmt::format(
        "a tick log of version {} cannot be read by this tact-view (version {}); make it "
        "again, or open it with the build that made it",
        log.magic[kVersionAt], firmware::telemetry::kLogMagic[kVersionAt])};
  if (in.read(&log.header_bytes, sizeof log - sizeof log.magic) < sizeof log - sizeof log.magic)
    return Error{"this tick log ends within its header"};
  if (log.ticks == 0)
    return Error{
        "this tick log holds no pictures, only what a replay needs; tactd --replay computes it "
        "again and writes its ticks with --csv; a black box or a recording of tact-view can be "
        "shown"};
  const Error no_pictures{
      "this black box is cut off before its pictures, or its header is damaged; tactd --replay "
      "FILE --csv FILE writes its ticks"};
  // Divided, not multiplied: the product of a damaged header could overflow to a valid offset.
  if (log.tick_bytes == 0 || log.ticks > file_bytes / log.tick_bytes ||
      log.header_bytes + log.ticks * log.tick_bytes >= file_bytes)
    return no_pictures;
  const std::uint64_t start = log.header_bytes + log.ticks * log.tick_bytes;
  if (start < sizeof log || !in.skip(start - sizeof log) || !read(in, magic)) return no_pictures;
  return start;
}

Error damaged(const Error& error) {
  return Error{error.message + "; nothing of it can be shown, record again"};
}

/// Bytes of the operator record after each frame; nothing: an unsupported version.
std::optional<std::size_t> operator_bytes_of(std::uint32_t version) {
  switch (version) {
    case kRecordingVersion:
      return 0;
    case kTrackedRecordingVersion:
      return sizeof(OperatorRecord);
    default:
      return std::nullopt;
  }
}

/// The error says why the file cannot be used.
Result<Setup> read_setup(SealedFile& in, const Magic& magic) {
  Setup setup;
  FileHeader header;
  constexpr std::size_t kRest = sizeof header - sizeof header.magic;
  std::memcpy(header.magic, magic.data(), sizeof header.magic);
  if (std::memcmp(header.magic, kRecordingMagic, sizeof header.magic) != 0 ||
      in.read(&header.version, kRest) < kRest) {
    return Error{
        "this is not a tact recording; give a file made with --record or the page's record "
        "button"};
  }
  const auto operator_bytes = operator_bytes_of(header.version);
  if (!operator_bytes) {
    return Error{
        fmt::format("recording version {} cannot be read by this tact-view (version {}, or {} with "
                    "an operator); record it again, or open it with the tact-view that made it",
                    header.version, kRecordingVersion, kTrackedRecordingVersion)};
  }
  setup.operator_bytes = *operator_bytes;
  if (header.hello_bytes != sizeof(Hello) || header.frame_bytes != sizeof(Frame)) {
    return Error{fmt::format(
        "its frames have {} bytes, those of this tact-view {}, though both say version {}; open it "
        "with the build that made it",
        header.frame_bytes, sizeof(Frame), header.version)};
  }
  constexpr const char* kCutOff =
      "the file ends before its first frame; nothing of it can be shown, record again";
  // Checked before allocating, because a length in a file may be wrong.
  if (!read(in, setup.hello) || header.mesh_bytes > in.size_bytes()) return Error{kCutOff};
  setup.mesh.resize(header.mesh_bytes);
  if (in.read(setup.mesh.data(), setup.mesh.size()) < setup.mesh.size()) return Error{kCutOff};
  if (crc_of(setup.hello, setup.mesh) != header.setup_crc)
    return Error{
        "its scene part is damaged (checksum differs); nothing of it can be shown, record again"};
  if (const std::optional<Error> error = check_hello(setup.hello)) return damaged(*error);
  if (const std::optional<Error> error = check_mesh(setup.hello, setup.mesh))
    return damaged(*error);
  return setup;
}

/// Adds the operator of a frame; false if its record is damaged.
bool add_operator(const OperatorRecord& tracked, Recording& recording) {
  const std::optional<tracking::TrackedOperator> seen = operator_of(tracked);
  recording.operators.push_back(seen.value_or(tracking::TrackedOperator{}));
  std::optional<figure::FigurePose> figure;
  // A damaged operator record repeats the last figure, so that it does not flicker.
  if (seen)
    figure = figure_of(tracked, *seen);
  else if (!recording.figures.empty())
    figure = recording.figures.back();
  recording.figures.push_back(std::move(figure));
  return seen.has_value();
}

/// Reads all good frames from byte `start` on. Empty, or the damage, with "; " at its end.
std::string read_frames(SealedFile& in, std::uint64_t start, std::size_t operator_bytes,
                        Recording& recording) {
  const std::uint64_t file_bytes = in.size_bytes();
  const std::uint64_t stride = sizeof(FrameRecord) + operator_bytes;
  const std::uint64_t records = (file_bytes - start) / stride;
  const std::uint64_t left_bytes = (file_bytes - start) % stride;
  recording.frames.reserve(records);
  std::uint64_t damaged = 0, first_damaged = 0, damaged_operators = 0;
  FrameRecord record;
  OperatorRecord tracked;
  for (std::uint64_t i = 0; i < records && read(in, record); ++i) {
    if (operator_bytes > 0 && !read(in, tracked)) break;
    // Frames have one size, so the next one is found even if this one is damaged.
    if (crc_of(record.frame) != record.crc || check_frame(record.frame, recording.hello)) {
      if (damaged++ == 0) first_damaged = start + i * stride;
      continue;
    }
    recording.frames.push_back(record.frame);
    if (operator_bytes > 0 && !add_operator(tracked, recording)) ++damaged_operators;
  }
  std::string damage;
  if (damaged > 0) {
    damage = fmt::format("{} of {} frames are damaged, the first at byte {}; ", damaged, records,
                         first_damaged);
  }
  if (damaged_operators > 0)
    damage += fmt::format("{} of {} frames have lost their operator; ", damaged_operators, records);
  if (left_bytes > 0) {
    damage +=
        fmt::format("the file is cut off inside a frame at byte {}; ", file_bytes - left_bytes);
  }
  if (const std::string trouble = in.trouble(); !trouble.empty()) damage += trouble + "; ";
  return damage;
}

ReadResult unusable(const Error& error) {
  return {.recording = {}, .usable = false, .damage = error.message};
}

}  // namespace

double Recording::length_s() const {
  if (frames.empty()) return 0.0;
  return static_cast<double>(frames.back().time_ns - frames.front().time_ns) * 1e-9;
}

std::optional<double> Recording::body_height_m() const {
  const auto first = std::ranges::find_if(figures, [](const auto& f) { return f.has_value(); });
  return first != figures.end() ? std::optional((*first)->height_m) : std::nullopt;
}

ReadResult read_recording(const std::string& path) {
  auto in = SealedFile::open(path, "check the name");
  if (!in) return unusable(in.error());
  Magic magic{};
  const Result<std::uint64_t> skipped = skip_ticks(*in, magic);
  if (!skipped) return unusable(skipped.error());
  Result<Setup> setup = read_setup(*in, magic);
  if (!setup) return unusable(setup.error());
  ReadResult result;
  Recording& recording = result.recording;
  recording.hello = setup->hello;
  recording.mesh = std::move(setup->mesh);
  const std::uint64_t start = *skipped + sizeof(FileHeader) + sizeof(Hello) + recording.mesh.size();
  result.damage = read_frames(*in, start, setup->operator_bytes, recording);
  result.usable = !recording.frames.empty();
  if (!result.damage.empty() || !result.usable) {
    result.damage += fmt::format("{} good frames ({:.1f} s) are kept", recording.frames.size(),
                                 recording.length_s());
  }
  return result;
}

}  // namespace tact::host::record
