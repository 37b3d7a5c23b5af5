// SPDX-License-Identifier: Apache-2.0
// recording.h - a run of tactd in one file, and the last minutes of it in memory.
//
// The format is firmware/protocol/run_file.h; a black box of tactd is a recording, too. Of a
// damaged or truncated file the good part is read, with one message about the rest. With a tracker
// it also has the operator and the figure shown, frame by frame (operator_record.h).
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/protocol/run_file.h"
#include "host/figure/figure.h"
#include "host/record/telemetry_check.h"
#include "model/result.h"

namespace tact::host::record {

struct Recording {
  RunHeader header;
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
  /// Height of the first figure in the recording.
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

/// The bytes before the first frame.
std::string start_of_recording(const RunHeader& header, const MeshBytes& mesh);

/// Writes one file, with a delay of at most a second. Never overwrites a file.
class RecordingWriter {
 public:
  /// The error states the cause and the remedy. After an error nothing more is written.
  std::optional<model::Error> open(const std::string& path, const RunHeader& header,
                                   const MeshBytes& mesh);
  /// The shown figure is kept if there is a tracker: `tracked` is not null.
  std::optional<model::Error> write(const Frame& frame,
                                    const tracking::TrackedOperator* tracked = nullptr,
                                    const figure::FigurePose* figure = nullptr);
  std::optional<model::Error> close();

 private:
  std::optional<model::Error> check();

  std::optional<firmware::protocol::RunWriter> file_;
  firmware::protocol::FieldTable fields_;  // of its frames
  std::int64_t flushed_ns_ = 0;
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
  RunHeader header;
  std::shared_ptr<const MeshBytes> mesh;
  std::vector<std::shared_ptr<const KeptFrame>> frames;
};

/// The snapshot of a whole recording.
Snapshot snapshot_of(Recording recording);

/// The newest frames, oldest first, of a limited time span, with the operator if tracked.
class RecentFrames {
 public:
  void restart(double frame_rate_Hz);
  void add(const Frame& frame, const tracking::TrackedOperator* tracked = nullptr,
           const figure::FigurePose* figure = nullptr);
  const std::deque<std::shared_ptr<const KeptFrame>>& frames() const { return frames_; }

  static constexpr double kKeep_s = 300.0;

 private:
  std::deque<std::shared_ptr<const KeptFrame>> frames_;
  std::size_t capacity_ = 0;
};

}  // namespace tact::host::record
