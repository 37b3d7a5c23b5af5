// SPDX-License-Identifier: Apache-2.0
// fault_latch.h - the first fault of a device stays, with its cause, for the loop and for messages.
//
// Any thread may set and read it. A cause is one atomic of 64 bits: no reader sees half of it.
#pragma once

#include <atomic>
#include <cstdint>
#include <type_traits>

#include "model/fault.h"

namespace tact::hal {

struct FaultCause {
  model::Fault fault = model::Fault::kNone;
  std::uint8_t axis = 0;   // 0, 1, 2
  std::uint8_t kind = 0;   // of the device's own list; 0: none
  std::uint32_t code = 0;  // means what the kind says
};

class FaultLatch {
 public:
  model::Fault fault() const RT_SAFE { return cause().fault; }

  /// Keeps the first one.
  void set(const FaultCause& cause) RT_SAFE {
    FaultCause none;
    cause_.compare_exchange_strong(none, cause, std::memory_order_relaxed);
  }
  /// The same fault, better known: a code often comes a frame later than the state.
  void explain(const FaultCause& cause) RT_SAFE {
    const FaultCause old = this->cause();
    if (old.fault == cause.fault && old.axis == cause.axis)
      cause_.store(cause, std::memory_order_relaxed);
  }
  FaultCause cause() const RT_SAFE { return cause_.load(std::memory_order_relaxed); }

 private:
  static_assert(std::atomic<FaultCause>::is_always_lock_free);
  static_assert(std::has_unique_object_representations_v<FaultCause>);  // compared bit by bit
  std::atomic<FaultCause> cause_{};
};

/// What the device waits for, which is no fault: the loop notes it, any thread reads it.
class WaitNote {
 public:
  void set(const FaultCause& cause) RT_SAFE { cause_.store(cause, std::memory_order_relaxed); }
  void clear() RT_SAFE { set({}); }
  /// The first cause; of kind 0 while there is none. Waits for nothing.
  FaultCause cause() const RT_SAFE { return cause_.load(std::memory_order_relaxed); }

 private:
  std::atomic<FaultCause> cause_{};
};

}  // namespace tact::hal
