// SPDX-License-Identifier: Apache-2.0
// median_reporter.h - the median of each Google Benchmark over its repetitions; prints nothing.
#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace tact::tools::tracking_bench {

class MedianReporter : public benchmark::BenchmarkReporter {
 public:
  // NOLINTBEGIN(readability-identifier-naming): the library's names
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      if (run.aggregate_name == "median")
        median_us[run.run_name.function_name] = run.GetAdjustedCPUTime();
  }
  // NOLINTEND(readability-identifier-naming)

  std::map<std::string, double> median_us;  // by the benchmark's name
};

/// Enough repetitions that their median stands still from run to run.
inline void repeat(benchmark::internal::Benchmark* timed) {
  timed->Unit(benchmark::kMicrosecond)->Repetitions(15)->MinTime(0.1)->ReportAggregatesOnly(true);
}

/// What was registered, run: median CPU time of each, us.
inline std::map<std::string, double> median_times_us() {
  MedianReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return reporter.median_us;
}

}  // namespace tact::tools::tracking_bench
