// SPDX-License-Identifier: Apache-2.0
// tick_times.h - what one tick of a loop took, phase by phase (RT-17), and the series of durations
// that ticks add up to.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "firmware/loop/latency_histogram.h"
#include "firmware/loop/tick_record.h"

namespace tact::tools::jitter {

/// CLOCK_MONOTONIC and ns throughout.
struct TickTimes {
  std::uint64_t tick = 0;  // over all slices of a run
  std::int64_t due_ns = 0;
  std::uint32_t skipped_before = 0;  // releases that had no tick, just before this one
  std::array<std::int32_t, firmware::loop::kPhaseCount> phase_ns{};

  std::int32_t phase(firmware::loop::Phase p) const {
    return phase_ns[static_cast<std::size_t>(p)];
  }
  std::int64_t wake_ns() const { return due_ns + phase(firmware::loop::Phase::kWake); }
  std::int64_t read_end_ns() const { return wake_ns() + phase(firmware::loop::Phase::kRead); }
  /// From its deadline to the force written.
  std::int64_t deadline_to_force_ns() const {
    using enum firmware::loop::Phase;
    std::int64_t sum = 0;
    for (const auto p : {kWake, kRead, kDetect, kRender, kLimit, kWrite}) sum += phase(p);
    return sum;
  }
  std::int64_t written_ns() const { return due_ns + deadline_to_force_ns(); }
};

/// Durations of one kind: a histogram, and when the largest was met.
struct Series {
  firmware::loop::LatencyHistogram histogram;
  std::int64_t max_at_ns = 0;  // CLOCK_MONOTONIC

  void record(std::int64_t duration_ns, std::uint64_t tick, std::int64_t at_ns) {
    const std::uint64_t before_ns = histogram.max_ns();
    histogram.record(duration_ns, tick);
    if (histogram.count() == 1 || histogram.max_ns() > before_ns) max_at_ns = at_ns;
  }
  /// Its samples at their buckets' upper edges; of the larger one's maximum the tick and time.
  void add(const Series& other) {
    other.histogram.for_each_bucket([&](std::uint64_t, std::uint64_t highest, std::uint64_t n) {
      const auto ns = static_cast<std::int64_t>(std::min(highest, other.histogram.max_ns()));
      for (std::uint64_t i = 0; i < n; ++i) record(ns, other.histogram.max_tick(), other.max_at_ns);
    });
  }
};

/// Nothing without a sample beyond it.
inline std::optional<std::uint64_t> percentile_ns(const firmware::loop::LatencyHistogram& histogram,
                                                  double share) {
  if (static_cast<double>(histogram.count()) * (1.0 - share) < 1.0 - 1e-9) return std::nullopt;
  return histogram.percentile_ns(share);
}

}  // namespace tact::tools::jitter
