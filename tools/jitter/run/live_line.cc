// SPDX-License-Identifier: Apache-2.0
#include "tools/jitter/run/live_line.h"

#include <fmt/format.h>

#include <cstdio>

namespace tact::tools::jitter {

using namespace std::chrono_literals;

std::string make_live_line(const TickSink& sink, double elapsed_s, double duration_s) {
  const auto us = [](std::uint64_t ns) { return 1e-3 * static_cast<double>(ns); };
  const auto& wake = sink.phase(firmware::loop::Phase::kWake).histogram;
  const auto& force = sink.deadline_to_force().histogram;
  return fmt::format(
      "{:.1f} of {:g} s  {} ticks  late {}  skipped {}  wake-up p50 {:.1f} p99.9 {:.1f} max {:.1f} "
      "us  force p99.9 {:.1f} us",
      elapsed_s, duration_s, sink.ticks(), sink.late(), sink.skipped(), us(wake.percentile_ns(0.5)),
      us(wake.percentile_ns(0.999)), us(wake.max_ns()), us(force.percentile_ns(0.999)));
}

void LiveLine::show(const TickSink& sink) {
  const auto now = std::chrono::steady_clock::now();
  if (now < due_ || sink.ticks() == 0) return;
  due_ = now + 200ms;
  const auto newest = sink.newest_due_ns();
  fmt::print(
      stderr, "\r\033[K{}",
      make_live_line(sink, 1e-9 * static_cast<double>(newest - sink.first_due_ns()), duration_s_));
  std::fflush(stderr);
}

void LiveLine::clear() {
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
}

}  // namespace tact::tools::jitter
