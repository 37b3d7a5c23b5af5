// SPDX-License-Identifier: Apache-2.0
// operator_signals.h - what a person at the PC asks of a running loop, by signals.
//
//     INT TERM HUP QUIT   force to zero, then leave; a closed terminal is one of them
//     USR1                reset: leaves a stop whose cause is gone; disarms first, never arms
//     USR2                arm
//
// After a stop both are needed, in this order: nothing moves again by itself.
#pragma once

#include <csignal>
#include <cstdint>
#include <functional>

#include "firmware/loop/rt_loop.h"

namespace tact::firmware::run {

/// The loop reads levels once per tick, so each must stand for some: at 100 Hz two.
void wait_several_ticks();

class OperatorSignals {
 public:
  /// Blocks them in this thread and in all that it starts: obey() takes them. `let_loop_read`
  /// returns once the loop has read the levels.
  explicit OperatorSignals(std::function<void()> let_loop_read = wait_several_ticks);

  /// Waits at most so long for one signal, and does what it asks.
  void obey(loop::Requests& requests, std::int64_t longest_ns) const;

 private:
  void reset(loop::Requests& requests) const;

  sigset_t signals_{};
  std::function<void()> let_loop_read_;
};

}  // namespace tact::firmware::run
