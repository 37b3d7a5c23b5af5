// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "tools/chart/measure/instructions.h"
#include "tools/chart/measure/measure.h"

namespace tact::tools::chart {
namespace {

using Clock = std::chrono::steady_clock;

// All chosen.
constexpr std::size_t kMaxWarmTicks = 500;
constexpr std::size_t kMinTicks = 100;
constexpr std::size_t kCountedTicks = 20;
constexpr double kBatch_s = 2e-6;       // a shorter tick is near the clock's own step
constexpr double kLongTick_s = 100e-6;  // a longer one has too many instructions to count

double ns_between(Clock::time_point a, Clock::time_point b) {
  return static_cast<double>(std::chrono::duration_cast<std::chrono::nanoseconds>(b - a).count());
}

double at_share(std::vector<double>& values, double share) {
  const auto last = static_cast<double>(values.size() - 1);
  const auto n = static_cast<std::ptrdiff_t>(std::lround(share * last));
  std::nth_element(values.begin(), values.begin() + n, values.end());
  return values[static_cast<std::size_t>(n)];
}

/// How often this thread had to make way for another.
long pauses_so_far() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw;
}

/// What two readings of the clock cost by themselves.
double clock_cost_ns() {
  std::vector<double> cost_ns(2000);
  for (double& c : cost_ns) {
    const auto begin = Clock::now();
    c = ns_between(begin, Clock::now());
  }
  return at_share(cost_ns, 0.5);
}

using Tick = std::function<void()>;

/// Warms the caches; how long a tick takes about.
double warm_tick_s(const Tick& tick, const TimingSettings& settings) {
  const auto warm_begin = Clock::now();
  std::size_t warm_ticks = 0;
  while (warm_ticks < kMaxWarmTicks &&
         ns_between(warm_begin, Clock::now()) < 0.05e9 * settings.limit_s) {
    tick();
    ++warm_ticks;
  }
  return 1e-9 * ns_between(warm_begin, Clock::now()) /
         static_cast<double>(std::max<std::size_t>(1, warm_ticks));
}

/// Each tick that nothing else interrupted.
void time_ticks(const Tick& tick, std::size_t ticks, double cost_ns, std::vector<double>& tick_ns) {
  tick_ns.clear();
  for (std::size_t i = 0; i < ticks; ++i) {
    const long pauses = pauses_so_far();
    const auto begin = Clock::now();
    tick();
    const auto end = Clock::now();
    // Time of other processes is the machine's load, not the law's cost (measure.h).
    if (pauses_so_far() == pauses)
      tick_ns.push_back(std::max(0.0, ns_between(begin, end) - cost_ns));
  }
}

/// The mean of each batch.
void time_batches(const Tick& tick, std::size_t batches, std::size_t batch, double cost_ns,
                  std::vector<double>& batch_ns) {
  batch_ns.clear();
  for (std::size_t i = 0; i < batches; ++i) {
    const auto begin = Clock::now();
    for (std::size_t k = 0; k < batch; ++k) tick();
    const double whole_ns = ns_between(begin, Clock::now()) - cost_ns;
    batch_ns.push_back(whole_ns / static_cast<double>(batch));
  }
}

}  // namespace

Timing measure_time(const Tick& tick, const TimingSettings& settings) {
  const double tick_s = warm_tick_s(tick, settings);
  const double room = settings.limit_s / (tick_s * settings.rounds);
  const std::size_t ticks = std::clamp(static_cast<std::size_t>(std::min(room, 1e9)), kMinTicks,
                                       std::max(kMinTicks, settings.ticks));
  const double cost_ns = clock_cost_ns();
  // ticks shorter than the clock's step: the median is that of the mean of a few
  const auto batch = static_cast<std::size_t>(std::clamp(kBatch_s / tick_s, 1.0, 64.0));
  constexpr double kNever_us = std::numeric_limits<double>::infinity();
  Timing best{.median_us = kNever_us,
              .p999_us = kNever_us,
              .instructions = std::numeric_limits<double>::quiet_NaN(),
              .ticks = ticks};
  std::vector<double> tick_ns, batch_ns;
  for (int round = 0; round < settings.rounds; ++round) {
    time_ticks(tick, ticks, cost_ns, tick_ns);
    time_batches(tick, batch > 1 ? ticks / batch : 0, batch, cost_ns, batch_ns);
    if (tick_ns.empty()) continue;
    const double p999_us = 1e-3 * at_share(tick_ns, 0.999);
    best.median_us = std::min(best.median_us, 1e-3 * at_share(batch > 1 ? batch_ns : tick_ns, 0.5));
    // The least of the rounds: noise only ever adds.
    if (p999_us >= best.p999_us) continue;
    best.p999_us = p999_us;
    best.paused = ticks - tick_ns.size();
  }
  if (settings.instructions && tick_s < kLongTick_s)
    best.instructions = instructions_per_call(tick, std::min(ticks, kCountedTicks));
  return best;
}

}  // namespace tact::tools::chart
