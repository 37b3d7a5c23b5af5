// SPDX-License-Identifier: Apache-2.0
// black_box.h - the last 10 s of every tick, written to a file whenever a fault latches.
//
// The telemetry thread, not the loop, adds ticks and frames. A separate thread writes, so a slow
// disk loses neither. A file is written 0.25 s after its fault, so that it contains the decay of
// the force, or at once if the loop no longer ticks. Several faults of a run give several files. A
// failed write is reported in a message, and the run continues.
#pragma once

#include <atomic>
#include <mutex>
#include <thread>

#include "firmware/black_box/black_box_file.h"
#include "firmware/black_box/newest_ones.h"
#include "firmware/telemetry/telemetry.h"

namespace tact::firmware::black_box {

class BlackBox final : public telemetry::Recorder {
 public:
  static constexpr double kKeep_s = 10.0, kAfter_s = 0.25;

  BlackBox(BlackBoxRun run, double rate_Hz, double frame_rate_Hz);
  ~BlackBox() override;
  BlackBox(const BlackBox&) = delete;
  BlackBox& operator=(const BlackBox&) = delete;

  void add(const loop::TickRecord& record) override;
  void add(const protocol::Frame& frame) override { frames_.add(frame); }
  void add_variant(const std::string& chunk) override { variants_ += chunk; }
  void stands(model::Fault fault) override;
  /// Starts to write the pending file, once its 0.25 s have passed.
  void work() override;
  /// Writes the pending file, if any.
  void finish() override;

  /// One message per event since the last call. Any thread.
  std::vector<std::string> news();
  /// Paths of all files so far. Any thread.
  std::vector<std::string> files() const;

 private:
  void write(const Kept& kept);

  BlackBoxRun run_;
  NewestOnes<protocol::LoggedTick> ticks_;
  NewestOnes<protocol::Frame> frames_;
  std::string variants_;       // all chunks so far
  std::uint64_t ticks_after_;  // kept after a fault, before the file is written
  model::Fault before_ = model::Fault::kNone, waiting_ = model::Fault::kNone;
  std::uint64_t to_wait_ = 0;  // ticks
  std::atomic<bool> writing_{false};
  std::thread writer_;
  mutable std::mutex reported_mutex_;  // the loop never takes it
  std::vector<std::string> news_, files_;
};

}  // namespace tact::firmware::black_box
