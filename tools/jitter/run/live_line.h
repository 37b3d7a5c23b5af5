// SPDX-License-Identifier: Apache-2.0
// live_line.h - a run in one line of the terminal, while it runs.
#pragma once

#include <chrono>

#include "tools/jitter/statistics/tick_sink.h"

namespace tact::tools::jitter {

class LiveLine {
 public:
  explicit LiveLine(double duration_s) : duration_s_(duration_s) {}

  /// A few times a second; does nothing in between. Goes to standard error.
  void show(const TickSink& sink);
  void clear();

 private:
  double duration_s_;
  std::chrono::steady_clock::time_point due_{};
};

/// "12.3 of 60 s  12300 ticks  late 0  skipped 0  wake-up p50 5.2 p99.9 31.0 max 80.0 us  ...".
std::string make_live_line(const TickSink& sink, double elapsed_s, double duration_s);

}  // namespace tact::tools::jitter
