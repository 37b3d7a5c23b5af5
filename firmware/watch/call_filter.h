// SPDX-License-Identifier: Apache-2.0
// call_filter.h - which system calls the loop's thread may make; any other ends in a stop
// (seccomp).
//
//     every loop      sleep and clock; return from a signal; the end of a thread
//     its device      what Device::loop_calls and SafetyLines::loop_calls list
//     any other       does not reach the kernel: the call fails, kForbiddenCall latches
//
// So no lock can be waited for and no file opened in the loop without being noticed: FUTEX_WAKE is
// allowed, because others may wait for a lock of the heap when the thread ends, FUTEX_WAIT is not.
// The filter belongs to the one thread that enters it, and stays with it to its end.
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
  /// Set-up. An error where there can be none: a sanitizer in the way, a kernel that refuses.
  static model::Result<std::unique_ptr<CallFilter>> make(std::span<const int> of_device,
                                                         std::span<const int> of_lines,
                                                         loop::Requests& requests);
  virtual ~CallFilter() = default;
  CallFilter(const CallFilter&) = delete;
  CallFilter& operator=(const CallFilter&) = delete;

  /// In the loop's thread, last before the loop; made filters are tried. 0, or the errno.
  virtual int enter_thread() = 0;
  /// In the loop's thread, first after the loop: what it calls now is no fault any more.
  virtual void leave_loop() = 0;

 protected:
  CallFilter() = default;
};

/// The first call that the newest filter refused, for a person; empty without one. Any thread.
std::string refused_call();

}  // namespace tact::firmware::watch
