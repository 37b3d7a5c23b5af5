// SPDX-License-Identifier: Apache-2.0
// ring.h - ring buffer of tick records from the loop to telemetry: wait-free, fixed capacity, drops
// when full. The shape of a patch takes the controller's latest-value slot instead.
#pragma once

#include <algorithm>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>

#include "firmware/loop/tick_record.h"

namespace tact::firmware::loop {

class TickRing {
 public:
  /// Holds one second of ticks: the lowest frame rate of a viewer is one per second.
  explicit TickRing(double rate_Hz = 1000.0)
      : queue_(std::max<std::size_t>(kMin, static_cast<std::size_t>(1.024 * rate_Hz))) {}

  /// Loop side. If the ring is full, drops the record and counts it.
  void push(const TickRecord& record) RT_SAFE;
  /// Telemetry side. False when empty.
  bool pop(TickRecord& record) { return queue_.pop(record); }
  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::size_t kMin = 4096;  // 4 s at 1 kHz, for a telemetry thread that is late
  boost::lockfree::spsc_queue<TickRecord> queue_;
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace tact::firmware::loop
