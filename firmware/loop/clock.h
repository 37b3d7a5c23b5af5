// SPDX-License-Identifier: Apache-2.0
// clock.h - the clocks of the loop. Only the loop reads them; what a tick calls gets the time as an
// argument. Threads of hal read the same clock by hal/monotonic.h.
#pragma once

#include <cstdint>

#include "model/rt.h"

namespace tact::firmware::loop {

class Clock {
 public:
  virtual ~Clock() = default;
  virtual std::int64_t now_ns() RT_SAFE = 0;
  /// A counter of constant but unknown rate; faster to read than now_ns().
  virtual std::int64_t mark() RT_SAFE { return now_ns(); }
  /// Returns at or after the deadline; immediately if it has passed.
  virtual void sleep_until_ns(std::int64_t deadline_ns) RT_SAFE = 0;
};

/// CLOCK_MONOTONIC with absolute deadlines.
class MonotonicClock final : public Clock {
 public:
  std::int64_t now_ns() RT_SAFE override;
  std::int64_t mark() RT_SAFE override {
#if defined(__x86_64__)
    return static_cast<std::int64_t>(__builtin_ia32_rdtsc());
#else
    return now_ns();
#endif
  }
  void sleep_until_ns(std::int64_t deadline_ns) RT_SAFE override;
  /// How long this PC was suspended since it was started: now_ns() does not count that.
  std::int64_t suspended_ns() RT_SAFE;
};

/// Time from the counter between two readings of the clock. The counter's rate comes from the last
/// two readings, one tick apart. If the rate changes (old CPUs with a variable clock), only the
/// durations measured in one tick are wrong: deadlines come from the clock.
class MarkedTime {
 public:
  /// Clock and counter, read at the same moment.
  void set(std::int64_t now_ns, std::int64_t mark) RT_SAFE {
    const auto marks = static_cast<double>(mark - mark_);
    if (mark_ != 0 && mark > mark_ && now_ns > now_ns_)
      ns_per_mark_ = static_cast<double>(now_ns - now_ns_) / marks;
    now_ns_ = now_ns;
    mark_ = mark;
  }
  std::int64_t at_ns(std::int64_t mark) const RT_SAFE {
    return now_ns_ + static_cast<std::int64_t>(static_cast<double>(mark - mark_) * ns_per_mark_);
  }

 private:
  std::int64_t now_ns_ = 0, mark_ = 0;
  double ns_per_mark_ = 1.0;
};

/// Time that advances only while the loop sleeps: runs as fast as the CPU allows, repeatably.
class SimulatedClock final : public Clock {
 public:
  std::int64_t now_ns() RT_SAFE override { return now_ns_; }
  void sleep_until_ns(std::int64_t deadline_ns) RT_SAFE override {
    if (deadline_ns > now_ns_) now_ns_ = deadline_ns;
  }

 private:
  std::int64_t now_ns_ = 0;
};

}  // namespace tact::firmware::loop
