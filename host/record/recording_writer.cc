// SPDX-License-Identifier: Apache-2.0
// Writes a recording, and keeps the last minutes in memory.
#include <algorithm>

#include "host/record/operator_record.h"
#include "host/record/recording.h"

namespace tact::host::record {
namespace {

// A crash loses a second at most, without a write to the disk for each frame.
constexpr std::int64_t kFlush_ns = 1'000'000'000;

using model::Error;

}  // namespace

std::optional<Error> RecordingWriter::open(const std::string& path, const Hello& hello,
                                           const MeshBytes& mesh, bool is_tracked) {
  is_tracked_ = is_tracked;
  file_.reset();
  auto file = model::io::SealedWriter::create(path);
  if (!file) return file.error();
  file_.emplace(std::move(*file));
  flushed_ns_ = 0;
  if (std::optional<Error> error = put(recording_start(
          hello, mesh, is_tracked ? kTrackedRecordingVersion : kRecordingVersion))) {
    return error;
  }
  return flush();
}

std::optional<Error> RecordingWriter::stop(const Error& error) {
  file_.reset();
  return Error{error.message + "; recording stopped, what was written before is kept"};
}

std::optional<Error> RecordingWriter::put(const std::string& bytes) {
  const auto error = file_->put(bytes);
  return error ? stop(*error) : std::nullopt;
}

std::optional<Error> RecordingWriter::flush() {
  const auto error = file_->flush();
  return error ? stop(*error) : std::nullopt;
}

std::optional<Error> RecordingWriter::write(const Frame& frame,
                                            const tracking::TrackedOperator* tracked,
                                            const figure::FigurePose* figure) {
  if (!file_) return std::nullopt;
  std::string bytes = recording_frame(frame);
  if (is_tracked_)
    bytes += operator_record(tracked != nullptr ? *tracked : tracking::TrackedOperator{}, figure);
  if (std::optional<Error> error = put(bytes)) return error;
  if (frame.time_ns - flushed_ns_ < kFlush_ns) return std::nullopt;
  flushed_ns_ = frame.time_ns;
  return flush();
}

std::optional<Error> RecordingWriter::close() {
  if (!file_) return std::nullopt;
  auto error = file_->finish();
  file_.reset();
  return error;
}

void RecentFrames::restart(double frame_rate_Hz) {
  frames_.clear();
  is_tracked_ = false;
  // The rate comes from a Hello; its bounds limit the memory.
  capacity_ = static_cast<std::size_t>(std::clamp(frame_rate_Hz, 1.0, 1000.0) * kKeep_s);
}

void RecentFrames::add(const Frame& frame, const tracking::TrackedOperator* tracked,
                       const figure::FigurePose* figure) {
  if (frames_.size() >= capacity_ && !frames_.empty()) frames_.pop_front();
  auto kept = std::make_shared<KeptFrame>(frame);
  // After the first tracked frame every later frame has an operator: records have one size.
  is_tracked_ = is_tracked_ || tracked != nullptr;
  if (is_tracked_) {
    kept->person = std::make_unique<const KeptOperator>(
        tracked != nullptr ? *tracked : tracking::TrackedOperator{},
        figure != nullptr ? std::optional(*figure) : std::nullopt);
  }
  frames_.push_back(std::move(kept));
}

}  // namespace tact::host::record
