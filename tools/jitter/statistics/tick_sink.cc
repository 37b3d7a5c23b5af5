// SPDX-License-Identifier: Apache-2.0
#include "tools/jitter/statistics/tick_sink.h"

#include <algorithm>

namespace tact::tools::jitter {

using firmware::loop::Phase;

namespace {

constexpr std::uint64_t kKeptBefore = 20, kKeptAfter = 5;  // ticks around a late one
constexpr std::array kOfThisTick{Phase::kWake,   Phase::kRead,  Phase::kDetect,
                                 Phase::kRender, Phase::kLimit, Phase::kWrite};

}  // namespace

void TickSink::begin_slice() {
  unfinished_.reset();  // its publish phase is not reported any more
  handed_ns_.reset();
  // A slice's loop counts from 0; the run goes on counting.
  base_ = ticks_ + unseen_;
  slice_wake_ = {};
}

void TickSink::add(const firmware::loop::TickRecord& record) {
  TickTimes times{.tick = base_ + record.tick,
                  .due_ns = record.due_ns,
                  .skipped_before = record.input.skipped_periods,
                  .phase_ns = record.phase_ns};
  if (ticks_ == 0) first_due_ns_ = times.due_ns;
  const std::uint64_t expected = ticks_ + unseen_;
  // A gap in the numbers: the ring was full. What crosses it cannot be measured.
  if (times.tick > expected) {
    unseen_ += times.tick - expected;
    unfinished_.reset();
    handed_ns_.reset();
  }
  ++ticks_;
  skipped_ += times.skipped_before;
  if (times.skipped_before > 0) ++late_;
  if (unfinished_) {
    for (const Phase p : {Phase::kPublish, Phase::kTotal})
      unfinished_->phase_ns[static_cast<std::size_t>(p)] = times.phase(p);
    finish(*unfinished_);
  }
  for (const Phase p : kOfThisTick)
    phases_[static_cast<std::size_t>(p)].record(times.phase(p), times.tick, times.due_ns);
  slice_wake_.record(times.phase(Phase::kWake), times.tick, times.due_ns);
  // Oldest first: of equal maxima the series keep the first.
  for (std::int64_t j = times.skipped_before; j >= 0; --j) {
    const std::int64_t waited_ns = j * settings_.period_ns;
    every_wake_.record(waited_ns + times.phase(Phase::kWake), times.tick, times.due_ns - waited_ns);
    deadline_to_force_.record(waited_ns + times.deadline_to_force_ns(), times.tick,
                              times.due_ns - waited_ns);
  }
  measure_round_trip(times, record);
  // These two are those of the tick before, and were given to it above.
  times.phase_ns[static_cast<std::size_t>(Phase::kPublish)] = 0;
  times.phase_ns[static_cast<std::size_t>(Phase::kTotal)] = 0;
  keep(times);
  const std::int64_t worst_ns =
      times.skipped_before * settings_.period_ns + times.deadline_to_force_ns();
  if (worst_ns > settings_.threshold_ns) note_late(times, worst_ns);
  unfinished_ = times;
}

void TickSink::finish(TickTimes times) {
  for (const Phase p : {Phase::kPublish, Phase::kTotal})
    phases_[static_cast<std::size_t>(p)].record(times.phase(p), times.tick, times.due_ns);
  for (auto* kept : {&newest_, &around_late_})
    if (const auto at = kept->find(times.tick); at != kept->end()) at->second = times;
}

void TickSink::measure_round_trip(const TickTimes& times,
                                  const firmware::loop::TickRecord& record) {
  const hal::Sample& sample = record.input.sample;
  // The first sample taken after the force was handed over: an older one knows nothing of it.
  if (handed_ns_ && sample.fresh && sample.stamp_ns >= *handed_ns_) {
    round_trip_.record(times.read_end_ns() - *handed_ns_, times.tick, *handed_ns_);
    handed_ns_.reset();
  }
  if (!handed_ns_) handed_ns_ = times.written_ns();
}

void TickSink::keep(const TickTimes& times) {
  newest_.emplace(times.tick, times);
  while (newest_.begin()->second.due_ns < times.due_ns - settings_.trace_ns)
    newest_.erase(newest_.begin());
  if (times.tick < keep_until_) around_late_.emplace(times.tick, times);
}

void TickSink::note_late(const TickTimes& times, std::int64_t worst_ns) {
  ++over_threshold_;
  if (late_ticks_.size() == kMaxLateTicks) {
    // The worst fifty, not the first: a run of a day would else show its first minute.
    const auto mildest = std::min_element(
        late_ticks_.begin(), late_ticks_.end(),
        [](const auto& a, const auto& b) { return a.second.worst_ns < b.second.worst_ns; });
    if (mildest->second.worst_ns >= worst_ns) return;
    late_ticks_.erase(mildest);
  }
  late_ticks_.emplace(times.tick, LateTick{times, worst_ns, {}});
  unexplained_.push_back(times.tick);
  const auto from = newest_.lower_bound(times.tick - std::min(times.tick, kKeptBefore));
  around_late_.insert(from, newest_.end());
  // What came after it may show the cause, too.
  keep_until_ = times.tick + kKeptAfter + 1;
  const std::uint64_t oldest = late_ticks_.begin()->first;
  around_late_.erase(around_late_.begin(),
                     around_late_.lower_bound(oldest - std::min(oldest, kKeptBefore)));
}

std::vector<LateTick*> TickSink::new_late_ticks() {
  std::vector<LateTick*> fresh;
  for (const std::uint64_t tick : unexplained_)
    if (const auto at = late_ticks_.find(tick); at != late_ticks_.end())
      fresh.push_back(&at->second);
  unexplained_.clear();
  return fresh;
}

std::vector<LateTick> TickSink::late_ticks() const {
  std::vector<LateTick> all;
  all.reserve(late_ticks_.size());
  for (const auto& [tick, late] : late_ticks_) all.push_back(late);
  std::sort(all.begin(), all.end(), [](const LateTick& a, const LateTick& b) {
    return a.worst_ns != b.worst_ns ? a.worst_ns > b.worst_ns : a.times.tick < b.times.tick;
  });
  return all;
}

std::vector<TickTimes> TickSink::kept_ticks() const {
  std::map<std::uint64_t, TickTimes> all = around_late_;
  // A tick of both is there once: a map takes no second one.
  all.insert(newest_.begin(), newest_.end());
  std::vector<TickTimes> ticks;
  ticks.reserve(all.size());
  for (const auto& [tick, times] : all) ticks.push_back(times);
  return ticks;
}

}  // namespace tact::tools::jitter
