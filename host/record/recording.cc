// SPDX-License-Identifier: Apache-2.0
#include "host/record/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "host/record/operator_record.h"

namespace tact::host::record {
namespace {

using firmware::protocol::Chunk;
using firmware::protocol::ChunkKind;
using firmware::protocol::RunReader;
using firmware::protocol::Unpacker;
using model::Error;
using model::Result;

/// Takes chunks of a file into a recording.
class RecordingReader {
 public:
  static Result<RecordingReader> make(const RunReader& file, Recording& recording) {
    auto frames = file.unpacker<Frame>();
    if (!frames) return frames.error();
    if (frames->missing().size() == Frame::fields().size())
      return Error{
          "this tick log holds no frames, only what a replay needs; tactd --replay computes it "
          "again and writes its ticks with --csv; a black box or a recording of tact-view can be "
          "shown"};
    auto operators = file.unpacker<OperatorRecord>();
    if (!operators) return operators.error();
    return RecordingReader(std::move(*frames), std::move(*operators), recording);
  }

  /// `skipped`: the bytes before it in the file are damaged. An error if nothing can be shown.
  std::optional<Error> add(const Chunk& chunk, bool skipped) {
    if (chunk.kind == ChunkKind::kMeshes) {
      recording_.mesh.resize(chunk.content.size());
      std::memcpy(recording_.mesh.data(), chunk.content.data(), chunk.content.size());
      return check_mesh(recording_.header, recording_.mesh);
    }
    if (skipped) hold_figure();
    if (chunk.kind == ChunkKind::kFrame) add_frame(chunk.content);
    // Behind a damaged frame an operator would appear at the frame before it.
    if (chunk.kind == ChunkKind::kOperator && has_frame_) add_operator(chunk.content);
    if (chunk.kind != ChunkKind::kTick) has_frame_ = chunk.kind == ChunkKind::kFrame && is_good_;
    return std::nullopt;
  }
  /// The last frame's operator is damaged: its figure is that of the frame before, so that it does
  /// not flicker.
  void hold_figure() {
    const std::size_t count = recording_.figures.size();
    if (has_frame_ && count > 1) recording_.figures[count - 1] = recording_.figures[count - 2];
    has_frame_ = false;
  }
  /// Frames and operators whose values are invalid, though their bytes are as written.
  std::string damage() const {
    std::string out;
    if (bad_frames_ > 0) out += fmt::format("{} frames have invalid values; ", bad_frames_);
    if (bad_operators_ > 0)
      out += fmt::format("{} frames have lost their operator; ", bad_operators_);
    return out;
  }

 private:
  RecordingReader(Unpacker frames, Unpacker operators, Recording& recording)
      : frames_(std::move(frames)), operators_(std::move(operators)), recording_(recording) {}

  void add_frame(const std::string& content) {
    Frame frame;
    is_good_ = frames_.unpack(content, &frame) && !check_frame(frame, recording_.header);
    if (!is_good_) {
      ++bad_frames_;
      return;
    }
    recording_.frames.push_back(frame);
    if (recording_.operators.empty()) return;
    recording_.operators.emplace_back();  // none, unless an operator follows
    recording_.figures.emplace_back();
  }

  void add_operator(const std::string& content) {
    if (recording_.operators.empty()) {
      recording_.operators.resize(recording_.frames.size());
      recording_.figures.resize(recording_.frames.size());
    }
    OperatorRecord record;
    const bool is_whole = operators_.unpack(content, &record);
    const auto tracked = is_whole ? operator_of(record) : std::nullopt;
    if (!tracked) {
      ++bad_operators_;
      return hold_figure();
    }
    recording_.operators.back() = *tracked;
    recording_.figures.back() = figure_of(record, *tracked);
  }

  Unpacker frames_, operators_;
  Recording& recording_;
  bool has_frame_ = false, is_good_ = false;  // the last chunk was a good frame
  std::uint64_t bad_frames_ = 0, bad_operators_ = 0;
};

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
  const auto unusable = [](const Error& error) {
    return ReadResult{.recording = {}, .usable = false, .damage = error.message};
  };
  auto file = RunReader::open(path, "check the name");
  if (!file) return unusable(file.error());
  ReadResult result;
  Recording& recording = result.recording;
  recording.header = file->header();
  if (const auto error = check_header(recording.header)) return unusable(*error);
  auto reader = RecordingReader::make(*file, recording);
  if (!reader) return unusable(reader.error());
  for (Chunk chunk; file->next(chunk);)
    if (const auto error = reader->add(chunk, file->skipped())) return unusable(*error);
  if (file->skipped()) reader->hold_figure();
  if (recording.mesh.empty())
    return unusable(
        Error{"its meshes are damaged or missing; nothing of it can be shown, record "
              "again"});
  result.damage = file->damage() + reader->damage();
  result.usable = !recording.frames.empty();
  if (!result.damage.empty() || !result.usable) {
    result.damage += fmt::format("{} good frames ({:.1f} s) are kept", recording.frames.size(),
                                 recording.length_s());
  }
  return result;
}

}  // namespace tact::host::record
