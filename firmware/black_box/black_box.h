// black_box.h - the last 10 s of every tick, written to a file whenever a fault latches.
//
// The telemetry thread adds ticks and frames, far from the loop; a thread of its own writes, so a
// slow disk costs neither ticks nor frames. A file waits for 0.25 s after its fault, so that it
// shows the force going; a loop that gives no more ticks is not waited for. Several faults of a run
// give several files. A disk that takes nothing is told in a sentence, and the run goes on.
#pragma once

#include <atomic>
#include <mutex>
#include <thread>

#include "firmware/black_box/black_box_file.h"
#include "firmware/black_box/newest_ones.h"

namespace tact::firmware {

class BlackBox {
 public:
  static constexpr double kKeep_s = 10.0, kAfter_s = 0.25;

  /// Takes over run.mesh_fd.
  BlackBox(BlackBoxRun run, double rate_Hz, double frame_rate_Hz);
  ~BlackBox();
  BlackBox(const BlackBox&) = delete;
  BlackBox& operator=(const BlackBox&) = delete;

  /// Telemetry thread.
  void add(const TickRecord& record);
  void add(const Frame& frame) { frames_.add(frame); }
  /// A fault of a loop that gives no ticks which could tell it; kNone is none.
  void stands(Fault fault);
  /// Now and then: hands over to the writer what has waited long enough.
  void work();
  /// At the end: writes what still waits; returns when all is on the disk.
  void finish();

  /// What happened since the last call, one sentence each. Any thread.
  std::vector<std::string> news();
  /// All files so far. Any thread.
  std::vector<std::string> files() const;

 private:
  void write(const Kept& kept);

  BlackBoxRun run_;
  NewestOnes<LoggedTick> ticks_;
  NewestOnes<Frame> frames_;
  std::uint64_t ticks_after_;  // of a fault, before it is written
  Fault before_ = Fault::kNone, waiting_ = Fault::kNone;
  std::uint64_t to_wait_ = 0;  // ticks
  std::atomic<bool> writing_{false};
  std::thread writer_;
  mutable std::mutex told_mutex_;  // never met by the loop
  std::vector<std::string> news_, files_;
};

}  // namespace tact::firmware
