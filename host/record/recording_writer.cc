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

std::shared_ptr<const KeptFrame> kept_frame(const Frame& frame,
                                            const tracking::TrackedOperator* tracked,
                                            const figure::FigurePose* figure) {
  auto kept = std::make_shared<KeptFrame>(frame);
  if (tracked != nullptr)
    kept->person = std::make_unique<const KeptOperator>(
        *tracked, figure != nullptr ? std::optional(*figure) : std::nullopt);
  return kept;
}

}  // namespace

Snapshot snapshot_of(Recording recording) {
  Snapshot out{.header = recording.header,
               .mesh = std::make_shared<const MeshBytes>(std::move(recording.mesh)),
               .frames = {}};
  for (std::size_t i = 0; i < recording.frames.size(); ++i)
    out.frames.push_back(
        kept_frame(recording.frames[i], recording.operator_at(i), recording.figure_at(i)));
  return out;
}

std::string start_of_recording(const RunHeader& header, const MeshBytes& mesh) {
  return start_of_run(header, mesh,
                      {firmware::protocol::schema_of<Frame>(Frame::fields(header.spheres.size())),
                       firmware::protocol::schema_of<OperatorRecord>()});
}

std::optional<Error> RecordingWriter::open(const std::string& path, const RunHeader& header,
                                           const MeshBytes& mesh) {
  file_.reset();
  auto file = firmware::protocol::RunWriter::create(path, start_of_recording(header, mesh));
  if (!file) return file.error();
  file_.emplace(std::move(*file));
  fields_ = Frame::fields(header.spheres.size());
  flushed_ns_ = 0;
  file_->flush();
  return check();
}

/// The error is returned once; from then on there is no file.
std::optional<Error> RecordingWriter::check() {
  const std::optional<Error> error = file_->error();
  if (!error) return std::nullopt;
  file_.reset();
  return Error{error->message + "; recording stopped"};
}

std::optional<Error> RecordingWriter::write(const Frame& frame,
                                            const tracking::TrackedOperator* tracked,
                                            const figure::FigurePose* figure) {
  if (!file_) return std::nullopt;
  file_->add(chunk_of(frame, fields_));
  if (tracked != nullptr) file_->add(operator_chunk(*tracked, figure));
  if (frame.time_ns - flushed_ns_ >= kFlush_ns) {
    flushed_ns_ = frame.time_ns;
    file_->flush();
  }
  return check();
}

std::optional<Error> RecordingWriter::close() {
  if (!file_) return std::nullopt;
  auto error = file_->close();
  file_.reset();
  return error;
}

void RecentFrames::restart(double frame_rate_Hz) {
  frames_.clear();
  // The rate comes from a RunHeader; its bounds limit the memory.
  capacity_ = static_cast<std::size_t>(std::clamp(frame_rate_Hz, 1.0, 1000.0) * kKeep_s);
}

void RecentFrames::add(const Frame& frame, const tracking::TrackedOperator* tracked,
                       const figure::FigurePose* figure) {
  if (frames_.size() >= capacity_ && !frames_.empty()) frames_.pop_front();
  frames_.push_back(kept_frame(frame, tracked, figure));
}

}  // namespace tact::host::record
