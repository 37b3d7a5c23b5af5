// SPDX-License-Identifier: Apache-2.0
#include "tools/jitter/trace/tick_trace.h"

#include <fmt/format.h>
#include <unistd.h>

#include <ctime>
#include <nlohmann/json.hpp>

#include "model/io/json.h"

namespace tact::tools::jitter {
namespace {

using firmware::loop::Phase;
using nlohmann::json;

constexpr std::array kInside{Phase::kRead,  Phase::kDetect, Phase::kRender,
                             Phase::kLimit, Phase::kWrite,  Phase::kPublish};
constexpr int kWakeTrack = 1, kLoopTrack = 2;

std::int64_t now_ns(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return std::int64_t{1'000'000'000} * t.tv_sec + t.tv_nsec;
}

/// An event of a track. The format counts in us.
json event(const char* type, int track, const std::string& name, std::int64_t time_ns) {
  return {{"ph", type},
          {"pid", getpid()},
          {"tid", track},
          {"name", name},
          {"ts", 1e-3 * static_cast<double>(time_ns)}};
}

json slice(int track, const std::string& name, std::int64_t from_ns, std::int64_t to_ns) {
  json out = event("X", track, name, from_ns);
  out["dur"] = 1e-3 * static_cast<double>(to_ns - from_ns);
  return out;
}

json track_name(const char* of, int track, const char* name) {
  json out = event("M", track, of, 0);
  out["args"] = {{"name", name}};
  return out;
}

}  // namespace

std::int64_t boottime_offset_ns() { return now_ns(CLOCK_BOOTTIME) - now_ns(CLOCK_MONOTONIC); }

std::string make_tick_trace(const std::vector<TickTimes>& ticks, std::int64_t offset_ns) {
  json events{track_name("process_name", 0, "tact-jitter"),
              track_name("thread_name", kWakeTrack, "wake-up"),
              track_name("thread_name", kLoopTrack, "tact-loop")};
  for (const TickTimes& t : ticks) {
    const std::int64_t due_ns = t.due_ns + offset_ns, wake_ns = t.wake_ns() + offset_ns;
    if (t.skipped_before > 0)
      events.push_back(event("i", kWakeTrack,
                             fmt::format("{} points of the grid without a tick", t.skipped_before),
                             due_ns));
    events.push_back(slice(kWakeTrack, "wake", due_ns, wake_ns));
    json latency = event("C", 0, "wake-up latency", wake_ns);
    latency["args"] = {{"ns", t.phase(Phase::kWake)}};
    events.push_back(std::move(latency));
    std::int64_t at_ns = wake_ns;
    json phases = json::array();
    for (const Phase p : kInside) {
      if (t.phase(p) == 0) continue;  // of a bare loop
      phases.push_back(slice(kLoopTrack, firmware::loop::kPhaseName[static_cast<std::size_t>(p)],
                             at_ns, at_ns + t.phase(p)));
      at_ns += t.phase(p);
    }
    events.push_back(slice(kLoopTrack, fmt::format("tick {}", t.tick), wake_ns, at_ns));
    for (json& phase : phases) events.push_back(std::move(phase));
  }
  return model::io::text_of(json{{"traceEvents", std::move(events)}, {"displayTimeUnit", "ns"}});
}

}  // namespace tact::tools::jitter
