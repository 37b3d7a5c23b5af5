// SPDX-License-Identifier: Apache-2.0
// latency_histogram.h - histogram of durations in ns: 64 equal buckets per power of two.
//
// Relative error of a percentile <= 1/64; fixed memory, O(1) recording without allocation. Values
// above 2^40 ns (18 minutes) count in the last bucket; the exact maximum is kept with its tick.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "model/rt.h"

namespace tact::firmware::loop {

class LatencyHistogram {
 public:
  void record(std::int64_t duration_ns, std::uint64_t tick) RT_SAFE {
    const std::uint64_t ns = duration_ns > 0 ? static_cast<std::uint64_t>(duration_ns) : 0;
    ++bucket_[bucket_of(ns)];
    ++count_;
    if (count_ == 1 || ns > max_ns_) max_ns_ = ns, max_tick_ = tick;
  }

  std::uint64_t count() const RT_SAFE { return count_; }
  std::uint64_t max_ns() const RT_SAFE { return max_ns_; }
  std::uint64_t max_tick() const RT_SAFE { return max_tick_; }

  /// Calls each(lowest_ns, highest_ns, samples) for every bucket that holds a sample, in order.
  template <typename Each>
  void for_each_bucket(Each each) const {
    for (std::size_t i = 0; i < kBuckets; ++i)
      if (bucket_[i] != 0) each(i == 0 ? 0 : highest_in(i - 1) + 1, highest_in(i), bucket_[i]);
  }

  /// Least value v such that at least this share of the samples is <= v, up to the bucket's width;
  /// 0 without samples.
  std::uint64_t percentile_ns(double share) const RT_SAFE {
    if (count_ == 0) return 0;
    const double wanted = share * static_cast<double>(count_);
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < kBuckets; ++i) {
      seen += bucket_[i];
      if (seen > 0 && static_cast<double>(seen) >= wanted)
        return highest_in(i) < max_ns_ ? highest_in(i) : max_ns_;
    }
    return max_ns_;
  }

 private:
  static constexpr unsigned kSubBits = 6;
  static constexpr unsigned kTopBit = 40;
  static constexpr std::size_t kSub = std::size_t{1} << kSubBits;
  static constexpr std::size_t kBuckets = (kTopBit - kSubBits + 1) * kSub;

  // Below 64 ns a bucket is 1 ns wide; above, the top 7 bits of the value select it.
  static constexpr std::size_t bucket_of(std::uint64_t ns) RT_SAFE {
    if (ns < kSub) return ns;
    const unsigned shift = static_cast<unsigned>(std::bit_width(ns)) - 1 - kSubBits;
    const std::size_t i = (shift + 1) * kSub + ((ns >> shift) - kSub);
    return i < kBuckets ? i : kBuckets - 1;
  }
  static constexpr std::uint64_t highest_in(std::size_t i) RT_SAFE {
    if (i < kSub) return i;
    const unsigned shift = static_cast<unsigned>(i / kSub) - 1;
    return ((static_cast<std::uint64_t>(kSub + i % kSub) + 1) << shift) - 1;
  }

  std::array<std::uint64_t, kBuckets> bucket_{};
  std::uint64_t count_ = 0, max_ns_ = 0, max_tick_ = 0;
};

}  // namespace tact::firmware::loop
