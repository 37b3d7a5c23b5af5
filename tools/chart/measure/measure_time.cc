// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "model/contact/site.h"
#include "tools/chart/measure/instructions.h"
#include "tools/chart/measure/measure.h"

namespace tact::tools::chart {
namespace {

using Clock = std::chrono::steady_clock;
using model::Vec3;
using model::contact::Indentation;

// All chosen. The path is so wide that touch meets new triangles.
constexpr std::size_t kPathTicks = 1000;  // one turn
constexpr double kPathRadius_m = 0.004;
constexpr std::size_t kMaxWarmTicks = 500;
constexpr std::size_t kMinTicks = 100;
constexpr std::size_t kCountedTicks = 20;
constexpr double kBatch_s = 2e-6;       // a shorter tick is near the clock's own step
constexpr double kLongTick_s = 100e-6;  // a longer one always meets other programs

/// Time that this thread was given, whatever else ran: for ticks so long that others always come in
/// between. Too dear and too coarse for short ones.
double own_time_ns() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
}

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

// Templates, so that what takes some nanoseconds is not called through a pointer.

/// Warms the caches; how long a tick takes about.
template <typename Tick>
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
template <typename Tick>
void time_ticks(const Tick& tick, std::size_t ticks, bool is_long, double cost_ns,
                std::vector<double>& tick_ns) {
  tick_ns.clear();
  for (std::size_t i = 0; i < ticks; ++i) {
    if (is_long) {
      const double begin_ns = own_time_ns();
      tick();
      tick_ns.push_back(own_time_ns() - begin_ns);
      continue;
    }
    const long pauses = pauses_so_far();
    const auto begin = Clock::now();
    tick();
    const auto end = Clock::now();
    // Whoever came in between is the machine's load, not the law's cost (measure.h).
    if (pauses_so_far() == pauses)
      tick_ns.push_back(std::max(0.0, ns_between(begin, end) - cost_ns));
  }
}

/// The mean of each batch.
template <typename Tick>
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

template <typename Tick>
Timing time_of(const Tick& tick, const TimingSettings& settings) {
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
    time_ticks(tick, ticks, tick_s > kLongTick_s, cost_ns, tick_ns);
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

}  // namespace

std::vector<Indentation> moving_probe(const model::scene::Scene& scene, const ProbeCase& at) {
  constexpr double kShallow_m = 0.001, kDeep_m = 0.009;
  const auto view = scene.organ_mesh.view();
  const Vec3 centre = point_of(view, at.in.place);
  const Vec3 side = std::abs(at.in.normal.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 e1 = normalized(cross(at.in.normal, side)), e2 = cross(at.in.normal, e1);
  std::vector<Indentation> path(kPathTicks, at.in);
  std::uint32_t triangle = at.in.place.triangle;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double turn_rad = 2.0 * M_PI * static_cast<double>(i) / kPathTicks;
    const Vec3 away = std::cos(turn_rad) * e1 + std::sin(turn_rad) * e2;
    path[i].place = follow(view, triangle, centre + kPathRadius_m * away).place;
    triangle = path[i].place.triangle;
    path[i].held = false;
    path[i].dent_m = kShallow_m + (kDeep_m - kShallow_m) * 0.5 * (1.0 - std::cos(2.0 * turn_rad));
  }
  return path;
}

Timing measure_time(Subject& subject, const std::vector<Indentation>& path,
                    const TimingSettings& settings) {
  std::size_t at = 0;
  const Timing timing = time_of(
      [&] {
        subject.tick(path[at]);
        at = at + 1 == path.size() ? 0 : at + 1;
      },
      settings);
  subject.release();
  return timing;
}

Timing measure_time(const std::function<void()>& tick, const TimingSettings& settings) {
  return time_of(tick, settings);
}

}  // namespace tact::tools::chart
