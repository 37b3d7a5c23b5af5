// SPDX-License-Identifier: Apache-2.0
#include "tools/jitter/trace/tick_trace.h"

#include <fmt/format.h>
#include <unistd.h>

#include <ctime>

#include "tools/jitter/trace/perfetto_trace.h"

namespace tact::tools::jitter {
namespace {

using firmware::loop::Phase;

constexpr std::array kInside{Phase::kRead,  Phase::kTouch, Phase::kFeel,
                             Phase::kJudge, Phase::kWrite, Phase::kTell};

std::int64_t now_ns(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return std::int64_t{1'000'000'000} * t.tv_sec + t.tv_nsec;
}

}  // namespace

std::int64_t boottime_offset_ns() { return now_ns(CLOCK_BOOTTIME) - now_ns(CLOCK_MONOTONIC); }

std::string make_tick_trace(const std::vector<TickTimes>& ticks, std::int64_t offset_ns) {
  PerfettoTrace trace;
  const auto process = trace.add_process(getpid(), "tact-jitter");
  const auto grid = trace.add_track(process, "wake-up");
  const auto loop = trace.add_track(process, "tact-loop");
  const auto latency = trace.add_counter_track(process, "wake-up latency", "ns");
  for (const TickTimes& t : ticks) {
    const std::int64_t due_ns = t.due_ns + offset_ns, wake_ns = t.wake_ns() + offset_ns;
    if (t.skipped_before > 0)
      trace.mark(grid, due_ns,
                 fmt::format("{} points of the grid without a tick", t.skipped_before));
    trace.begin_slice(grid, due_ns, "wake");
    trace.end_slice(grid, wake_ns);
    trace.count(latency, wake_ns, t.phase(Phase::kWake));
    trace.begin_slice(loop, wake_ns, fmt::format("tick {}", t.tick));
    std::int64_t at_ns = wake_ns;
    for (const Phase p : kInside) {
      if (t.phase(p) == 0) continue;  // of a bare loop
      trace.begin_slice(loop, at_ns, firmware::loop::kPhaseName[static_cast<std::size_t>(p)]);
      at_ns += t.phase(p);
      trace.end_slice(loop, at_ns);
    }
    trace.end_slice(loop, at_ns);
  }
  return trace.bytes();
}

}  // namespace tact::tools::jitter
