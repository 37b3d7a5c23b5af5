// SPDX-License-Identifier: Apache-2.0
// progress.h - progress of the loop, written by the loop, read by the watch (loop_monitor.h).
//
// The loop only makes relaxed stores, a few per tick, and never waits.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "firmware/loop/state.h"
#include "model/fault.h"
#include "model/types.h"

namespace tact::firmware::loop {

/// Whose code the loop is running; names the cause if a call hangs.
enum class Callee : std::uint8_t { kOwn, kLines, kDevice };

/// What a tick has written, for a person who asks.
struct Shown {
  std::int64_t time_ns = 0;  // CLOCK_MONOTONIC; 0: no tick yet
  State state = State::kOff;
  model::Fault fault = model::Fault::kNone;
  std::array<float, 3> force_N{};
};

class Progress {
 public:
  /// Loop side.
  void tick() RT_SAFE {
    ticks_.store(ticks_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }
  void enter(Callee callee) RT_SAFE { callee_.store(callee, std::memory_order_relaxed); }
  void show(const Shown& now) RT_SAFE {
    for (std::size_t i = 0; i < 3; ++i)
      force_N_[i].store(now.force_N[i], std::memory_order_relaxed);
    state_.store(now.state, std::memory_order_relaxed);
    fault_.store(now.fault, std::memory_order_relaxed);
    time_ns_.store(now.time_ns, std::memory_order_relaxed);
  }
  /// Zero force is written and the loop makes no further call.
  void end() RT_SAFE { ended_.store(true, std::memory_order_relaxed); }

  /// Watch side.
  std::uint64_t ticks() const RT_SAFE { return ticks_.load(std::memory_order_relaxed); }
  Callee callee() const RT_SAFE { return callee_.load(std::memory_order_relaxed); }
  bool running() const RT_SAFE { return ticks() > 0 && !ended_.load(std::memory_order_relaxed); }

  /// Any thread. Its parts may be of two ticks that follow each other.
  Shown shown() const {
    return {.time_ns = time_ns_.load(),
            .state = state_.load(),
            .fault = fault_.load(),
            .force_N = {force_N_[0].load(), force_N_[1].load(), force_N_[2].load()}};
  }

 private:
  std::array<std::atomic<float>, 3> force_N_{};
  std::atomic<State> state_{State::kOff};
  std::atomic<model::Fault> fault_{model::Fault::kNone};
  std::atomic<std::int64_t> time_ns_{0};
  std::atomic<std::uint64_t> ticks_{0};
  std::atomic<Callee> callee_{Callee::kOwn};
  std::atomic<bool> ended_{false};
};

}  // namespace tact::firmware::loop
