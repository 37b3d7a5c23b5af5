// SPDX-License-Identifier: Apache-2.0
// usb_thread.h - the thread that waits for USB: "tact-usb", above the loop, gone without a trace.
//
// SCHED_FIFO 82 lies above the loop (80), which the thread serves, and below the interrupt threads
// it waits for. Where that is refused it runs at normal priority. It takes no signals. Before it
// ends it drops to SCHED_OTHER: what the kernel frees for it must not delay the loop.
#pragma once

#include <pthread.h>

#include <atomic>
#include <cstdint>

namespace tact::hal::falcon_usb {

inline constexpr int kUsbThreadPriority = 82;

class UsbThread {
 public:
  UsbThread() = default;
  ~UsbThread() { join(); }
  UsbThread(const UsbThread&) = delete;
  UsbThread& operator=(const UsbThread&) = delete;

  /// Runs body(argument) once; 0 or an errno.
  int start(void (*body)(void*), void* argument);
  /// Waits for its end; at once when it never ran.
  void join();
  bool started() const { return joinable_; }
  /// The body has returned.
  bool ended() const { return ended_.load(std::memory_order_acquire); }
  /// Scheduling policy at the end of the body, after it was dropped; -1 before.
  int last_policy() const { return last_policy_.load(std::memory_order_acquire); }

 private:
  static void* enter(void* self);

  pthread_t thread_{};
  bool joinable_ = false;
  void (*body_)(void*) = nullptr;
  void* argument_ = nullptr;
  std::atomic<bool> ended_{false};
  std::atomic<int> last_policy_{-1};
};

void usb_pause_ns(std::int64_t pause_ns);

}  // namespace tact::hal::falcon_usb
