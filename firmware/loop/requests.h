// SPDX-License-Identifier: Apache-2.0
// requests.h - what people and the watch ask of a running loop; written by other threads and signal
// handlers.
//
// What a person asks has a number. The loop does or refuses it in one tick, and echoes the number
// with what came of it: nobody waits to be sure that a level was seen.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "model/fault.h"
#include "model/rt.h"

namespace tact::firmware::loop {

enum class Request : std::uint8_t { kNone, kArm, kReset, kDisarm };

struct Requests {
  std::atomic<std::uint32_t> asked{0};    // number of the newest request, times 4, and which it is
  std::atomic<std::uint32_t> echoed{0};   // number that the loop has answered, times 4; 1: done
  std::atomic<bool> arm_at_start{false};  // once, as soon as it is ready: the loop's own request
  std::atomic<bool> stop{false};          // force to zero, then leave
  std::atomic<model::Fault> fault{model::Fault::kNone};  // of the watch; the first stays
  std::atomic<std::uint32_t> refused{0};  // requests to arm or reset that were refused

  /// Takes the place of one that is not answered yet. Returns its number; one thread may ask.
  std::uint32_t ask(Request request) {
    const std::uint32_t number = (asked.load(std::memory_order_relaxed) >> 2) + 1;
    asked.store(number << 2 | static_cast<std::uint32_t>(request), std::memory_order_relaxed);
    return number;
  }
  /// Not done from now on, unless a tick has taken it: its answer says which.
  void take_back() { asked.fetch_and(~3U, std::memory_order_relaxed); }
  /// What came of it: done, refused, or not answered yet.
  std::optional<bool> answer(std::uint32_t number) const {
    const std::uint32_t echo = echoed.load(std::memory_order_relaxed);
    if (((echo >> 2 ^ number) << 2) != 0) return std::nullopt;
    return (echo & 1) != 0;
  }
  /// For the loop: its answer to the request that `asked` had.
  void echo(std::uint32_t request, bool done) RT_SAFE {
    echoed.store((request & ~3U) | (done ? 1U : 0U), std::memory_order_relaxed);
  }

  void trip(model::Fault found) RT_SAFE {
    model::Fault none = model::Fault::kNone;
    fault.compare_exchange_strong(none, found, std::memory_order_relaxed);
  }
};

}  // namespace tact::firmware::loop
