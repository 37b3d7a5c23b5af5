// SPDX-License-Identifier: Apache-2.0
// call_filter.h - a seccomp filter: which system calls the loop's thread may make.
//
//     every loop      sleep and clock; return from a signal; the end of a thread
//     its device      the calls listed by Device::loop_calls and SafetyLines::loop_calls
//     any other       fails before it reaches the kernel, and kForbiddenCall latches
//
// The loop can therefore neither wait for a lock nor open a file unnoticed. FUTEX_WAIT is refused;
// FUTEX_WAKE is allowed, because other threads may wait for a heap lock when this thread ends. The
// filter applies to the one thread that enters it, until that thread ends.
//
// Source: seccomp(2) SECCOMP_RET_TRAP, libseccomp 2.5.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "firmware/loop/rt_loop.h"
#include "model/result.h"

namespace tact::firmware::watch {

class CallFilter {
 public:
  /// Set-up. An error under a sanitizer, or where the kernel refuses the filter.
  static model::Result<std::unique_ptr<CallFilter>> make(std::span<const int> of_device,
                                                         std::span<const int> of_lines,
                                                         loop::Requests& requests);
  virtual ~CallFilter() = default;
  CallFilter(const CallFilter&) = delete;
  CallFilter& operator=(const CallFilter&) = delete;

  /// In the loop's thread, as the last step before the loop. 0, or the errno.
  virtual int enter_thread() = 0;
  /// In the loop's thread, as the first step after the loop: later calls are no longer a fault.
  virtual void leave_loop() = 0;

 protected:
  CallFilter() = default;
};

/// Name and number of the first refused call of the newest filter, or empty. Any thread.
std::string refused_call();

}  // namespace tact::firmware::watch
