// SPDX-License-Identifier: Apache-2.0
// black_box.h - the last 10 s of every tick, written to a file whenever a fault latches.
//
// The telemetry thread adds ticks and frames, far from the loop; a thread of its own writes, so a
// slow disk costs neither ticks nor frames. A file waits for 0.25 s after its fault, so that it
// shows the force going; a loop that gives no more ticks is not waited for. Several faults of a run
// give several files. A disk that takes nothing is told in a message, and the run goes on.
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

  /// Takes over run.mesh_fd.
  BlackBox(BlackBoxRun run, double rate_Hz, double frame_rate_Hz);
  ~BlackBox() override;
  BlackBox(const BlackBox&) = delete;
  BlackBox& operator=(const BlackBox&) = delete;

  void add(const loop::TickRecord& record) override;
  void add(const telemetry::Frame& frame) override { frames_.add(frame); }
  void stands(model::Fault fault) override;
  /// Hands over to the writer what has waited long enough.
  void work() override;
  /// Writes what still waits.
  void finish() override;

  /// What happened since the last call, one message each. Any thread.
  std::vector<std::string> news();
  /// All files so far. Any thread.
  std::vector<std::string> files() const;

 private:
  void write(const Kept& kept);

  BlackBoxRun run_;
  NewestOnes<telemetry::LoggedTick> ticks_;
  NewestOnes<telemetry::Frame> frames_;
  std::uint64_t ticks_after_;  // of a fault, before it is written
  model::Fault before_ = model::Fault::kNone, waiting_ = model::Fault::kNone;
  std::uint64_t to_wait_ = 0;  // ticks
  std::atomic<bool> writing_{false};
  std::thread writer_;
  mutable std::mutex reported_mutex_;  // never met by the loop
  std::vector<std::string> news_, files_;
};

}  // namespace tact::firmware::black_box
