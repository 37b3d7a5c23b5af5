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

#include "firmware/rt_loop.h"

namespace tact::firmware {

class OperatorSignals {
 public:
  /// Blocks them in this thread and in all that it starts: obey() takes them.
  OperatorSignals();

  /// Waits at most so long for one signal, and does what it asks.
  void obey(Requests& requests, std::int64_t longest_ns) const;

 private:
  sigset_t signals_{};
};

}  // namespace tact::firmware
