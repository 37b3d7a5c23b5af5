// ring.h - the way of every tick out of the loop: wait-free, fixed capacity, drops when full, never
// waits. Only a patch's shape goes another way, through the controller's latest-value slot.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>

#include "firmware/tick_record.h"

namespace tact::firmware {

class TickRing {
 public:
  /// Loop side. A full ring drops the record and counts it.
  void push(const TickRecord& record) RT_SAFE;
  /// Telemetry side. False when empty.
  bool pop(TickRecord& record) { return queue_.pop(record); }
  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::size_t kCapacity = 4096;  // 4 s at 1 kHz, 1 s at 4 kHz
  boost::lockfree::spsc_queue<TickRecord, boost::lockfree::capacity<kCapacity>> queue_;
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace tact::firmware
