// SPDX-License-Identifier: Apache-2.0
// requests.h - requests of a person and of the watch to a running loop; written by other threads
// and signal handlers.
//
// A person's request has a number. The loop executes or refuses it in one tick and echoes the
// number with the result.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "model/fault.h"
#include "model/rt.h"

namespace tact::firmware::loop {

enum class Request : std::uint8_t { kNone, kArm, kReset, kDisarm };

struct Requests {
  std::atomic<std::uint32_t> asked{0};    // number of the newest request times 4, plus a Request
  std::atomic<std::uint32_t> echoed{0};   // number of the answered request times 4; +1: done
  std::atomic<bool> arm_at_start{false};  // arm once, as soon as the state is Ready
  std::atomic<bool> stop{false};          // zero force, then end the loop
  std::atomic<model::Fault> fault{model::Fault::kNone};  // first fault of the watch
  std::atomic<std::uint32_t> refused{0};  // requests refused: arm by the loop, others before it
  // 1 to 255: an event that no tick has taken; else 256 times the number of the next tick
  std::atomic<std::uint64_t> event{0};

  /// Replaces a request that is not answered yet. Returns the number; only one thread may ask.
  std::uint32_t ask(Request request) {
    const std::uint32_t number = (asked.load(std::memory_order_relaxed) >> 2) + 1;
    asked.store(number << 2 | static_cast<std::uint32_t>(request), std::memory_order_relaxed);
    return number;
  }
  /// Cancels the request if no tick has taken it yet; answer() shows which.
  void take_back() { asked.fetch_and(~3U, std::memory_order_relaxed); }
  /// True: done; false: refused; empty: not answered yet.
  std::optional<bool> answer(std::uint32_t number) const {
    const std::uint32_t echo = echoed.load(std::memory_order_relaxed);
    if (((echo >> 2 ^ number) << 2) != 0) return std::nullopt;
    return (echo & 1) != 0;
  }
  /// Loop side: answers the request with this value of `asked`.
  void echo(std::uint32_t request, bool done) RT_SAFE {
    echoed.store((request & ~3U) | (done ? 1U : 0U), std::memory_order_relaxed);
  }

  /// Loop side: the event of this tick, 0: none.
  std::uint8_t take_event(std::uint64_t tick) RT_SAFE {
    std::uint64_t asked_event = event.load(std::memory_order_relaxed);
    const auto number = static_cast<std::uint8_t>(asked_event);
    // Withdrawn in this moment: as if it had not come.
    return number != 0 && event.compare_exchange_strong(asked_event, (tick + 1) << 8,
                                                        std::memory_order_relaxed)
               ? number
               : 0;
  }

  void trip(model::Fault found) RT_SAFE {
    model::Fault none = model::Fault::kNone;
    fault.compare_exchange_strong(none, found, std::memory_order_relaxed);
  }
};

}  // namespace tact::firmware::loop
