// SPDX-License-Identifier: Apache-2.0
// usb_thread.h - the thread that waits for USB: "tact-usb", above the loop, gone without a trace.
//
// SCHED_FIFO 82 lies above the loop (80), which the thread serves, and below the interrupt threads
// it waits for. Where that is refused it runs at normal priority. Before it ends it drops to
// SCHED_OTHER: what the kernel frees for it must not delay the loop.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

#include "hal/threads/thread.h"

namespace tact::hal::falcon_usb {

inline constexpr int kUsbThreadPriority = 82;

class UsbThread {
 public:
  /// Runs `body` once.
  [[nodiscard]] std::optional<model::Error> start(std::function<void()> body);
  /// Waits for its end; at once when it never ran.
  void join() { thread_.join(); }
  bool started() const { return thread_.joinable(); }
  /// The body has returned.
  bool ended() const { return ended_.load(std::memory_order_acquire); }
  /// Scheduling policy at the end of the body, after it was dropped; -1 before.
  int last_policy() const { return last_policy_.load(std::memory_order_acquire); }

 private:
  std::atomic<bool> ended_{false};
  std::atomic<int> last_policy_{-1};
  threads::Thread thread_;
};

void usb_pause_ns(std::int64_t pause_ns);

}  // namespace tact::hal::falcon_usb
