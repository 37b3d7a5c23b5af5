// SPDX-License-Identifier: Apache-2.0
// guardian.h - tactd's side of the process that zeroes the device after tactd has died.
//
//     start        spawns tact-guardian from this program's folder and sends it the shutdown
//                  frames, the device's descriptor and the liveness lock
//     page()       tactd's watch and the guardian count in it; each acts when the other is silent
//     tact-guard   a thread of tactd that holds the liveness lock (liveness_lock.h) for its whole
//                  life and detects the end of the guardian at once
//     destructor   releases the lock after the device is off: the guardian ends, nothing is sent
//
// The guardian is spawned, not forked, because after a fork the loop's locked pages would fault
// again. None of this runs in the loop: the watch polls is_lost() (watch/loop_monitor.h).
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <semaphore>
#include <string>

#include "firmware/guardian/liveness_lock.h"
#include "hal/shutdown_frames.h"
#include "hal/threads/thread.h"
#include "model/result.h"

namespace tact::firmware::guardian {

struct GuardianSettings {
  int priority = 0;  // SCHED_FIFO, of the guardian and of the thread that holds the lock
  std::int64_t silence_ns = 300'000'000;  // tactd counts no further: the guardian acts
  std::int64_t period_ns = 1'000'000;     // of the loop, whose deadlines it leaves alone
  std::string program;                    // empty: tact-guardian in the folder of this program
};

class Guardian {
 public:
  /// Returns when the guardian is ready. The device must stay open until the destructor ends.
  static model::Result<std::unique_ptr<Guardian>> start(const hal::ShutdownFrames& frames,
                                                        const GuardianSettings& settings);
  ~Guardian();
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  /// The guardian has ended unasked: a crash of tactd would not zero the device. Any thread.
  const std::atomic<bool>& is_lost() const { return lost_; }
  pid_t process() const { return process_; }
  /// The watch counts here that tactd is not held, and sees that the guardian is not.
  LivenessPage& page() const { return liveness_.page(); }

 private:
  explicit Guardian(LivenessLock liveness) : liveness_(std::move(liveness)) {}
  [[nodiscard]] std::optional<int> spawn(const std::string& program);
  bool is_ready() const;
  void keep(int priority);

  LivenessLock liveness_;
  int socket_ = -1;   // hangs up when the guardian ends
  int dismiss_ = -1;  // eventfd
  pid_t process_ = -1;
  std::binary_semaphore held_{0};
  std::atomic<bool> lost_{false};
  hal::threads::Thread thread_;
};

}  // namespace tact::firmware::guardian
