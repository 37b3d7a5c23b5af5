// clock.h - the only door to time on the way of a tick. All of it gets time as an argument.
#pragma once

#include <cstdint>

#include "model/rt.h"

namespace tact::firmware {

class Clock {
 public:
  virtual ~Clock() = default;
  virtual std::int64_t now_ns() RT_SAFE = 0;
  /// Returns at or after the deadline; at once when it has passed.
  virtual void sleep_until_ns(std::int64_t deadline_ns) RT_SAFE = 0;
};

/// CLOCK_MONOTONIC with absolute deadlines.
class MonotonicClock final : public Clock {
 public:
  std::int64_t now_ns() RT_SAFE override;
  void sleep_until_ns(std::int64_t deadline_ns) RT_SAFE override;
};

/// Time that only passes while the loop sleeps: runs as fast as the CPU allows, always the same.
class SimulatedClock final : public Clock {
 public:
  std::int64_t now_ns() RT_SAFE override { return now_ns_; }
  void sleep_until_ns(std::int64_t deadline_ns) RT_SAFE override {
    if (deadline_ns > now_ns_) now_ns_ = deadline_ns;
  }
  /// A tick that takes long: for tests of late ticks.
  void pass_ns(std::int64_t duration_ns) RT_SAFE { now_ns_ += duration_ns; }

 private:
  std::int64_t now_ns_ = 0;
};

}  // namespace tact::firmware
