// SPDX-License-Identifier: Apache-2.0
// tick_sink.h - from the ring of a running loop to histograms: one series per phase, and three that
// the phases alone do not show.
//
//     every wake-up       wake-up latency of every point of the grid. A tick that comes late hides
//                         the points it skipped: each of those waited, too, by whole periods more.
//                         Left out, a stall of 50 ms would count as one late sample of 50, and the
//                         percentiles would be too good (coordinated omission; G. Tene, 2013)
//     deadline to force   the same from each point of the grid to the next force written
//     device round trip   from a force handed to the device until the loop has read a sample that
//                         was taken after it
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "tools/jitter/statistics/tick_times.h"

namespace tact::tools::jitter {

/// A tick that took longer than the threshold.
struct LateTick {
  TickTimes times;
  std::int64_t worst_ns = 0;  // deadline to force, of the oldest grid point it serves
  std::string attribution;    // what the kernel counted around it; costs.h
};

struct SinkSettings {
  std::int64_t period_ns = 1'000'000;
  std::int64_t threshold_ns = 100'000;    // of deadline to force
  std::int64_t trace_ns = 3'000'000'000;  // how much of the end of a run is kept tick by tick
};

class TickSink {
 public:
  static constexpr std::size_t kMaxLateTicks = 50;  // kept one by one: the worst ones

  explicit TickSink(const SinkSettings& settings) : settings_(settings) {}

  /// A loop starts again: its ticks count from 0 again, on another grid.
  void begin_slice();
  void add(const firmware::loop::TickRecord& record);

  std::uint64_t ticks() const { return ticks_; }
  std::uint64_t skipped() const { return skipped_; }
  /// Ticks that took longer than a period: the releases after them had no tick.
  std::uint64_t late() const { return late_; }
  /// Ticks that the ring has dropped: in no histogram.
  std::uint64_t unseen() const { return unseen_; }
  std::uint64_t over_threshold() const { return over_threshold_; }
  std::int64_t first_due_ns() const { return first_due_ns_; }
  std::int64_t newest_due_ns() const { return unfinished_ ? unfinished_->due_ns : first_due_ns_; }
  std::int64_t threshold_ns() const { return settings_.threshold_ns; }

  const Series& phase(firmware::loop::Phase p) const {
    return phases_[static_cast<std::size_t>(p)];
  }
  /// Wake-up of the ticks since begin_slice().
  const Series& slice_wake() const { return slice_wake_; }
  const Series& every_wake() const { return every_wake_; }
  const Series& deadline_to_force() const { return deadline_to_force_; }
  const Series& round_trip() const { return round_trip_; }

  /// The worst ticks above the threshold, worst first.
  std::vector<LateTick> late_ticks() const;
  /// Those since the last call that want an attribution.
  std::vector<LateTick*> new_late_ticks();
  /// Every kept tick in order: the end of the run and the surroundings of the worst ticks.
  std::vector<TickTimes> kept_ticks() const;

 private:
  void finish(TickTimes times);
  void measure_round_trip(const TickTimes& times, const firmware::loop::TickRecord& record);
  void keep(const TickTimes& times);
  void note_late(const TickTimes& times, std::int64_t worst_ns);

  SinkSettings settings_;
  std::array<Series, firmware::loop::kPhaseCount> phases_;
  Series slice_wake_, every_wake_, deadline_to_force_, round_trip_;
  std::uint64_t ticks_ = 0, skipped_ = 0, late_ = 0, unseen_ = 0, over_threshold_ = 0;
  std::uint64_t base_ = 0;  // number of the slice's first tick
  std::int64_t first_due_ns_ = 0;
  std::optional<TickTimes> unfinished_;    // publish and total come with the next record
  std::optional<std::int64_t> handed_ns_;  // a force that no sample has followed yet
  std::map<std::uint64_t, TickTimes> newest_, around_late_;  // by tick
  std::uint64_t keep_until_ = 0;
  std::map<std::uint64_t, LateTick> late_ticks_;  // by tick
  std::vector<std::uint64_t> unexplained_;
};

}  // namespace tact::tools::jitter
