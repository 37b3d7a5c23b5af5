// SPDX-License-Identifier: Apache-2.0
#include "tools/jitter/run/jitter_run.h"

#include <gtest/gtest.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>

#include "firmware/loop/release_schedule.h"
#include "tests/support/no_alloc.h"
#include "tests/support/program.h"
#include "tests/support/puppet_loop.h"
#include "tools/jitter/run/bare_loop.h"
#include "tools/jitter/run/load.h"

namespace tact::tools::jitter::jitter_run_test {

using firmware::loop::Phase;
using firmware::loop::TickRecord;
using tests::run_program;

constexpr std::int64_t kMs = 1'000'000;

/// A tick of a 1 kHz loop that woke so much late, and took 10 us in each phase up to write.
TickRecord tick_at(std::uint64_t tick, std::int64_t due_ns, std::int32_t wake_ns,
                   std::uint32_t skipped = 0) {
  TickRecord record;
  record.tick = tick;
  record.due_ns = due_ns;
  record.input.skipped_periods = skipped;
  record.phase_ns = {wake_ns, 10'000, 10'000, 10'000, 10'000, 10'000, 5'000, 55'000};
  return record;
}

/// 1000 ticks of which one stalls for 50 ms; then the releases it slept over are skipped.
TickSink stalled_run() {
  TickSink sink({});
  for (std::uint64_t i = 0; i < 500; ++i)
    sink.add(tick_at(i, static_cast<std::int64_t>(i) * kMs, 5'000));
  sink.add(tick_at(500, 500 * kMs, 50'000'000));
  sink.add(tick_at(501, 551 * kMs, 5'000, 50));
  for (std::uint64_t i = 502; i < 950; ++i)
    sink.add(tick_at(i, static_cast<std::int64_t>(i + 50) * kMs, 5'000));
  return sink;
}

TEST(TickSink, ASliceHasTheWakeUpsOfItsOwnTicksAlone) {
  TickSink sink = stalled_run();
  sink.begin_slice();
  for (std::uint64_t i = 0; i < 10; ++i)
    sink.add(tick_at(i, static_cast<std::int64_t>(2000 + i) * kMs, 7'000));
  EXPECT_EQ(sink.slice_wake().histogram.count(), 10u);
  EXPECT_EQ(sink.slice_wake().histogram.max_ns(), 7'000u) << "the stall was in the slice before";
}

TEST(TickSink, AStallCountsForEveryPointOfTheGridThatItHid) {
  const TickSink sink = stalled_run();
  EXPECT_EQ(sink.ticks(), 950u);
  EXPECT_EQ(sink.skipped(), 50u);
  EXPECT_EQ(sink.late(), 1u);
  const auto& wake = sink.phase(Phase::kWake).histogram;
  const auto& every = sink.every_wake().histogram;
  EXPECT_EQ(wake.count(), 950u);
  EXPECT_EQ(every.count(), 1000u) << "one for every point of the grid";
  // Waits: 50 ms once; of the 50 hidden points 50.005, 49.005, ... 1.005 ms. So of 1000 samples 51
  // are above 1 ms, and 20 of them above 31.005 ms. Per tick, the stall is one sample in 950.
  EXPECT_LT(wake.percentile_ns(0.99), 6'000u) << "the trap that this series avoids";
  EXPECT_NEAR(static_cast<double>(every.percentile_ns(0.98)), 31.005e6, 31.005e6 / 64);
  EXPECT_LT(every.percentile_ns(0.94), 6'000u);
  EXPECT_EQ(every.max_ns(), 50'005'000u);
  EXPECT_EQ(sink.every_wake().max_at_ns, 501 * kMs) << "the oldest point that waited";
}

TEST(TickSink, AForceCountsFromTheDeadlineThatAskedForIt) {
  const TickSink sink = stalled_run();
  EXPECT_EQ(sink.deadline_to_force().histogram.count(), 1000u);
  // wake 5 us and five phases of 10 us
  EXPECT_NEAR(static_cast<double>(sink.deadline_to_force().histogram.percentile_ns(0.5)), 55e3,
              55e3 / 64);
  EXPECT_EQ(sink.deadline_to_force().histogram.max_ns(), 50'055'000u);
}

TEST(TickSink, PublishAndTotalBelongToTheTickBefore) {
  TickSink sink({});
  sink.add(tick_at(0, 0, 5'000));
  EXPECT_EQ(sink.phase(Phase::kTotal).histogram.count(), 0u);
  TickRecord next = tick_at(1, kMs, 5'000);
  next.phase_ns[static_cast<std::size_t>(Phase::kTotal)] = 77'000;
  sink.add(next);
  EXPECT_EQ(sink.phase(Phase::kTotal).histogram.max_ns(), 77'000u);
  EXPECT_EQ(sink.phase(Phase::kTotal).histogram.max_tick(), 0u);
}

TEST(TickSink, TicksThatTheRingDroppedAreReportedNotGuessed) {
  TickSink sink({});
  sink.add(tick_at(0, 0, 5'000));
  sink.add(tick_at(7, 7 * kMs, 5'000));
  EXPECT_EQ(sink.unseen(), 6u);
  EXPECT_EQ(sink.ticks(), 2u);
  EXPECT_EQ(sink.phase(Phase::kTotal).histogram.count(), 0u)
      << "the end of tick 0 was not reported";
}

TEST(TickSink, SlicesGoOnCountingAndNothingCrossesTheGap) {
  TickSink sink({});
  sink.add(tick_at(0, 0, 5'000));
  sink.begin_slice();
  sink.add(tick_at(0, 900 * kMs, 5'000));
  EXPECT_EQ(sink.ticks(), 2u);
  EXPECT_EQ(sink.unseen(), 0u);
  EXPECT_EQ(sink.phase(Phase::kTotal).histogram.count(), 0u);
  EXPECT_EQ(sink.kept_ticks().back().tick, 1u);
}

TEST(TickSink, TheRoundTripEndsWithASampleTakenAfterTheForce) {
  TickSink sink({});
  TickRecord record = tick_at(0, 0, 5'000);  // its force is written at 55 us
  sink.add(record);
  for (const auto& [due_ns, stamp_ns] :
       {std::pair{kMs, std::int64_t{54'999}}, {2 * kMs, std::int64_t{55'000}}}) {
    record = tick_at(static_cast<std::uint64_t>(due_ns / kMs), due_ns, 5'000);
    record.input.sample.fresh = true;
    record.input.sample.stamp_ns = stamp_ns;
    sink.add(record);
  }
  ASSERT_EQ(sink.round_trip().histogram.count(), 1u);
  // Read at 2 ms + 5 us + 10 us.
  EXPECT_EQ(sink.round_trip().histogram.max_ns(), 2'015'000u - 55'000u);
}

TEST(TickSink, KeepsTheWorstTicksAndWhatLedToThem) {
  TickSink sink({.threshold_ns = 100'000, .trace_ns = 100 * kMs});
  for (std::uint64_t i = 0; i < 1000; ++i)
    sink.add(tick_at(i, static_cast<std::int64_t>(i) * kMs,
                     i % 10 == 0 ? 200'000 + static_cast<std::int32_t>(i) : 5'000));
  EXPECT_EQ(sink.over_threshold(), 100u);
  const auto late = sink.late_ticks();
  ASSERT_EQ(late.size(), TickSink::kMaxLateTicks);
  EXPECT_EQ(late.front().times.tick, 990u);
  EXPECT_EQ(late.back().times.tick, 500u);
  const auto kept = sink.kept_ticks();
  EXPECT_LE(kept.front().tick, 490u);
  EXPECT_GE(kept.front().tick, 400u) << "what led to a tick that is no longer kept goes, too";
  for (std::size_t i = 1; i < kept.size(); ++i) EXPECT_LT(kept[i - 1].tick, kept[i].tick);
}

using JitterLoop = firmware::PuppetLoop;

TEST_F(JitterLoop, TheSinkAgreesWithTheRealLoopOnEveryPeriod) {
  TickSink sink({});
  sink.begin_slice();
  for (int i = 0; i < 300; ++i) {
    if (i % 100 == 50) device.slow_ns = 3'400'000;
    loop.step();
    TickRecord record;
    while (ring->pop(record)) sink.add(record);
  }
  const auto& counted = loop.statistics();
  EXPECT_EQ(sink.ticks(), counted.ticks);
  EXPECT_EQ(sink.late(), counted.late_ticks);
  EXPECT_EQ(sink.skipped(), counted.skipped_ticks);
  EXPECT_EQ(sink.every_wake().histogram.count(), counted.ticks + counted.skipped_ticks);
  EXPECT_EQ(sink.phase(Phase::kRead).histogram.max_ns(), 3'400'000u);
  EXPECT_EQ(sink.deadline_to_force().histogram.max_ns(), 3'400'000u);
}

TEST(BareLoop, KeepsTheGridOfTheRealLoopAndTheHeapAlone) {
  // A clock that sleeps 3.4 ms too long once.
  class Sleeper final : public firmware::loop::Clock {
   public:
    std::int64_t now_ns() RT_SAFE override { return now_ns_; }
    void sleep_until_ns(std::int64_t deadline_ns) RT_SAFE override {
      now_ns_ = std::max(now_ns_, deadline_ns + (++sleeps == 6 ? 3'400'000 : 2'000));
    }
    int sleeps = 0;

   private:
    std::int64_t now_ns_ = 17;
  } clock;
  const auto ring = std::make_unique<firmware::loop::TickRing>();
  const std::atomic<bool> stop{false};
  BareLoop loop(kMs, 20, clock, stop, *ring);
  {
    const tests::NoAlloc guard;
    loop.run();
    EXPECT_EQ(guard.calls(), 0u);
  }
  TickSink sink({});
  TickRecord record;
  while (ring->pop(record)) {
    sink.add(record);
    const auto periods = static_cast<std::int64_t>(sink.ticks() + sink.skipped());
    EXPECT_EQ(record.due_ns, firmware::loop::next_deadline_ns(17, kMs) + periods * kMs)
        << "each tick is due at its own point of the grid";
  }
  EXPECT_EQ(sink.ticks() + sink.skipped(), 20u);
  EXPECT_EQ(sink.skipped(), 3u);
  EXPECT_EQ(sink.phase(Phase::kWake).histogram.max_ns(), 3'400'000u);
}

TEST(Load, EveryKindLoadsSomethingElse) {
  std::vector<std::vector<std::string>> all;
  for (const std::string& kind : load_kinds())
    all.push_back(stress_arguments({kind}, 4, "/x", 90.0));
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(all[i], all[j]);
  EXPECT_GT(stress_arguments(load_kinds(), 4, "/x", 90.0).size(), all[0].size());
}

TEST(PulseMeter, AnEdgeThatWasLostMakesNoPulse) {
  PulseMeter meter(kMs);
  const hal::gpio::Edge edges[] = {{false, 5},     {true, 100},          {false, 20'100},
                                   {true, 30'000}, {true, 40'000},       {false, 70'000},
                                   {true, 80'000}, {false, 80'001 + kMs}};
  for (const hal::gpio::Edge& edge : edges) meter.add(edge);
  EXPECT_EQ(meter.pulses().histogram.count(), 2u);
  EXPECT_EQ(meter.pulses().histogram.max_ns(), 30'000u);
  EXPECT_EQ(meter.unpaired(), 3u) << "a fall at the start, a rise, a pulse over a period";
}

TEST(LoopBack, ReadsUntilItIsStopped) {
  class Pulses final : public hal::gpio::EdgeMonitor {
   public:
    explicit Pulses(std::atomic<int>& reads) : reads_{reads} {}
    std::vector<hal::gpio::Edge> read(std::chrono::milliseconds) override {
      now_ns_ += kMs;
      ++reads_;
      return {{true, now_ns_}, {false, now_ns_ + 7'000}};
    }

   private:
    std::atomic<int>& reads_;
    std::int64_t now_ns_ = 0;
  };
  std::atomic<int> reads{0};
  const auto loop_back = std::move(*LoopBack::start(std::make_unique<Pulses>(reads), kMs));
  while (reads < 2) std::this_thread::yield();
  const PulseMeter meter = loop_back->stop();
  EXPECT_GT(meter.pulses().histogram.count(), 0u);
  EXPECT_EQ(meter.pulses().histogram.max_ns(), 7'000u);
  EXPECT_EQ(meter.unpaired(), 0u);
}

}  // namespace tact::tools::jitter::jitter_run_test
