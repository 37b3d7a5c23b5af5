// SPDX-License-Identifier: Apache-2.0
// black_box.h - the last 10 s of every tick, written to a file whenever a fault latches.
//
// The telemetry thread, not the loop, adds ticks and frames. A thread of its own writes, so a slow
// disk loses neither; it and its memory are there before the loop. A file is written 0.25 s after
// its fault, so that it contains the decay of the force, or at once if the loop no longer ticks.
// Several faults of a run give several files. A failed write is reported in a message, and the run
// continues.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <semaphore>

#include "firmware/black_box/black_box_file.h"
#include "firmware/black_box/newest_ones.h"
#include "firmware/telemetry/telemetry.h"
#include "hal/threads/thread.h"

namespace tact::firmware::black_box {

class BlackBox final : public telemetry::Recorder {
 public:
  static constexpr double kKeep_s = 10.0, kAfter_s = 0.25;

  /// Takes all memory that a fault needs, and starts the thread that writes.
  static model::Result<std::unique_ptr<BlackBox>> make(BlackBoxRun run, double rate_Hz,
                                                       double frame_rate_Hz);
  ~BlackBox() override;
  BlackBox(const BlackBox&) = delete;
  BlackBox& operator=(const BlackBox&) = delete;

  void add(const protocol::LoggedTick& tick) override;
  void add(const protocol::Frame& frame) override { frames_.add(frame); }
  void add_variant(const std::string& chunk) override { variants_ += chunk; }
  void report_fault(model::Fault fault) override;
  /// Starts to write the pending file, once its 0.25 s have passed.
  void work() override;
  /// Writes the pending file, if any.
  void finish() override;

  /// One message per event since the last call. Any thread.
  std::vector<std::string> news();
  /// Paths of all files so far. Any thread.
  std::vector<std::string> files() const;

 private:
  // Chosen: more than the strings of one file need; more messages than anybody reads.
  static constexpr std::size_t kSpare_bytes = 1 << 18, kMaxNews = 100;

  BlackBox(BlackBoxRun run, double rate_Hz, double frame_rate_Hz);
  void keep_writing();
  void write();
  void report(std::string news);

  BlackBoxRun run_;
  NewestOnes<protocol::LoggedTick> ticks_;
  NewestOnes<protocol::Frame> frames_;
  std::string variants_;       // all chunks so far
  std::uint64_t ticks_after_;  // kept after a fault, before the file is written
  model::Fault before_ = model::Fault::kNone, waiting_ = model::Fault::kNone;
  std::uint64_t to_wait_ = 0;  // ticks
  Kept kept_;                  // of the writer while it is not idle
  std::vector<char> spare_;
  std::binary_semaphore due_{0}, idle_{1};
  std::atomic<bool> ending_{false};
  mutable std::mutex reported_mutex_;  // the loop never takes it
  std::vector<std::string> news_, files_;
  hal::threads::Thread writer_;  // last: it uses the others
};

}  // namespace tact::firmware::black_box
