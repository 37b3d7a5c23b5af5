// SPDX-License-Identifier: Apache-2.0
// recording.h - a run of tactd in one file, and the last minutes of it in memory.
//
// The file's layout is in firmware/telemetry/recording_format.h; a black box of tactd contains a
// recording, too. Of a damaged or truncated file the good part is read, with one message about the
// rest. With a tracker it also has the operator and the figure shown, frame by frame
// (operator_record.h).
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/telemetry/recording_format.h"
#include "host/figure/figure.h"
#include "host/record/telemetry_check.h"
#include "model/io/seal.h"
#include "model/result.h"

namespace tact::host::record {

using firmware::telemetry::FileHeader;
using firmware::telemetry::FrameRecord;
using firmware::telemetry::kRecordingMagic;
using firmware::telemetry::kRecordingVersion;
using firmware::telemetry::kTrackedRecordingVersion;
using firmware::telemetry::recording_frame;
using firmware::telemetry::recording_start;

struct Recording {
  Hello hello;
  MeshBytes mesh;
  std::vector<Frame> frames;
  std::vector<tracking::TrackedOperator> operators;        // one per frame; empty without a tracker
  std::vector<std::optional<figure::FigurePose>> figures;  // as shown; one per operator

  /// Null without a tracker.
  const tracking::TrackedOperator* operator_at(std::size_t frame) const {
    return operators.empty() ? nullptr : &operators[frame];
  }
  /// Null if no figure was shown.
  const figure::FigurePose* figure_at(std::size_t frame) const {
    return frame < figures.size() && figures[frame] ? &*figures[frame] : nullptr;
  }
  /// Of the first figure in the recording.
  std::optional<double> body_height_m() const;
  double length_s() const;
};

/// Not a Result: a damaged file gives both its good part and a message.
struct ReadResult {
  Recording recording;
  bool usable = false;  // scene and at least one frame are good
  std::string damage;   // empty when the whole file is good
};
ReadResult read_recording(const std::string& path);

/// Writes one file, with a delay of at most a second. Never overwrites a file.
class RecordingWriter {
 public:
  /// The error states the cause and the remedy. After an error nothing more is written.
  std::optional<model::Error> open(const std::string& path, const Hello& hello,
                                   const MeshBytes& mesh, bool is_tracked = false);
  /// `tracked` and the shown figure are used only if is_tracked.
  std::optional<model::Error> write(const Frame& frame,
                                    const tracking::TrackedOperator* tracked = nullptr,
                                    const figure::FigurePose* figure = nullptr);
  std::optional<model::Error> close();

 private:
  std::optional<model::Error> put(const std::string& bytes);
  std::optional<model::Error> flush();
  std::optional<model::Error> stop(const model::Error& error);

  std::optional<model::io::SealedWriter> file_;
  std::int64_t flushed_ns_ = 0;
  bool is_tracked_ = false;
};

/// The operator at one frame.
struct KeptOperator {
  tracking::TrackedOperator tracked;
  std::optional<figure::FigurePose> figure;  // as it was shown
};

struct KeptFrame {
  Frame frame;
  std::unique_ptr<const KeptOperator> person;  // none without a tracker
};

/// A part of a run. Frames and meshes are shared between its holders.
struct Snapshot {
  Hello hello;
  std::shared_ptr<const MeshBytes> mesh;
  std::vector<std::shared_ptr<const KeptFrame>> frames;
  bool is_tracked = false;
};

/// The newest frames, oldest first, of a limited time span, with the operator if tracked.
class RecentFrames {
 public:
  void restart(double frame_rate_Hz);
  void add(const Frame& frame, const tracking::TrackedOperator* tracked = nullptr,
           const figure::FigurePose* figure = nullptr);
  const std::deque<std::shared_ptr<const KeptFrame>>& frames() const { return frames_; }
  /// True if any of them has a tracked operator.
  bool is_tracked() const { return is_tracked_; }

  static constexpr double kKeep_s = 300.0;

 private:
  std::deque<std::shared_ptr<const KeptFrame>> frames_;
  bool is_tracked_ = false;
  std::size_t capacity_ = 0;
};

}  // namespace tact::host::record
