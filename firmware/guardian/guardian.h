// SPDX-License-Identifier: Apache-2.0
// guardian.h - tactd's side of the process that zeroes the device when tactd has died.
//
//     start      the program tact-guardian next to this one gets shutdown frames, descriptor,
//                liveness lock
//     tact-guard a thread of tactd that holds the liveness lock (liveness lock.h) for its whole
//     life, and
//                hears at once when the guardian ends
//     destructor lets go, after the device is off: the guardian ends and has sent nothing
//
// It is spawned, not forked: a fork would make the loop's locked pages faults again. Nothing of it
// is in the loop: the watch looks at is_lost() (watch/loop_monitor.h).
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <semaphore>
#include <string>
#include <thread>

#include "firmware/guardian/liveness_lock.h"
#include "hal/shutdown_frames.h"
#include "model/result.h"

namespace tact::firmware::guardian {

struct GuardianSettings {
  int priority = 0;     // SCHED_FIFO, of the guardian and of the thread whose end it waits for
  std::string program;  // empty: tact-guardian in the folder of this program
};

class Guardian {
 public:
  /// Ready when it returns. The device must stay open as long as the guardian.
  static model::Result<std::unique_ptr<Guardian>> start(const hal::ShutdownFrames& words,
                                                        const GuardianSettings& settings);
  ~Guardian();
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  /// It has ended, and not because it was let go: nobody zeroes the device any more. Any thread.
  const std::atomic<bool>& is_lost() const { return lost_; }
  pid_t process() const { return process_; }

 private:
  explicit Guardian(LivenessLock liveness) : liveness_(std::move(liveness)) {}
  [[nodiscard]] std::optional<int> spawn(const std::string& program);
  bool is_ready() const;
  void keep(int priority);

  LivenessLock liveness_;
  int socket_ = -1;   // its death hangs this up
  int dismiss_ = -1;  // eventfd
  pid_t process_ = -1;
  std::binary_semaphore held_{0};
  std::atomic<bool> lost_{false};
  std::thread thread_;
};

}  // namespace tact::firmware::guardian
