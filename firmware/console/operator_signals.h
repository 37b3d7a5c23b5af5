// SPDX-License-Identifier: Apache-2.0
// operator_signals.h - what a person at the PC asks of a running loop, by signals.
//
//     INT TERM HUP QUIT TSTP ABRT   force to zero, then leave; a closed terminal is one of them
//     USR1                          reset: leaves a stop whose cause is gone; never arms
//     USR2                          arm
//
// After a stop both are needed, in this order: nothing moves again by itself. What every other
// signal does is in README.md.
#pragma once

#include <csignal>
#include <cstdint>

namespace tact::firmware::console {

enum class Act : std::uint8_t { kNone, kLeave, kReset, kArm };

/// First of all in main: USR1 and USR2 wait from now on, and no signal that somebody sends by
/// mistake ends or halts a process whose loop pushes. A file that may not grow is an error of its
/// writer. A crash of its own ends it all the same: the kernel heeds nobody's wish to ignore that.
void outlive_stray_signals();

class OperatorSignals {
 public:
  /// Blocks them in this thread and in all that it starts: wait() takes them.
  OperatorSignals();
  ~OperatorSignals();
  OperatorSignals(const OperatorSignals&) = delete;
  OperatorSignals& operator=(const OperatorSignals&) = delete;

  /// What the next signal asks for; waits at most so long for one, or until `other_fd` is readable.
  Act wait(std::int64_t longest_ns, int other_fd = -1) const;
  /// Those of USR1 and USR2 that came until now are gone. Returns how many kinds there were.
  int forget() const;

 private:
  sigset_t signals_{};
  int signal_fd_ = -1;  // readable while one waits; without it they are seen when the time is up
};

}  // namespace tact::firmware::console
