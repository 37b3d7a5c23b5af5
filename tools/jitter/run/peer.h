// SPDX-License-Identifier: Apache-2.0
// peer.h - cyclictest of rt-tests beside the loop: the same priority, core, period and load, in
// slices that take turns with the loop's, so that both meet the same weather.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/result.h"
#include "tools/jitter/statistics/tick_times.h"
#include "tools/program/run_program.h"

namespace tact::tools::jitter {

struct PeerCall {
  int core = 0;
  int priority = 80;
  std::int64_t period_ns = 1'000'000;
  double duration_s = 1.0;
};

/// Periods in the call's duration.
std::uint64_t cycles_of(const PeerCall& call);

/// The arguments of cyclictest; its JSON goes to `json_path`.
std::vector<std::string> cyclictest_arguments(const PeerCall& call, const std::string& json_path);

/// Adds what cyclictest has written to a series. Its buckets are whole microseconds; each counts at
/// its upper edge, as ours do. Values beyond its histogram are known by number and largest alone:
/// all of them count as the largest. More samples than the cycles that were asked for: an error.
std::optional<model::Error> add_cyclictest(const std::string& json, std::uint64_t asked_cycles,
                                           Series& series);

/// The loop's 99.9th percentile over the peer's; nothing where one of them has too few samples.
std::optional<double> ratio_at_p999(const Series& loop, const Series& peer);

/// The middle of the turns' ratios. One stall of a machine that others share decides p99.9 of the
/// turn it falls into, and so of a short run; it does not move the middle of many turns.
struct TurnRatios {
  std::size_t turns = 0;
  double lower_quartile = 0.0, median = 0.0, upper_quartile = 0.0;
};
/// Nothing of fewer than three turns.
std::optional<TurnRatios> middle_of(std::vector<double> ratios);

/// What a gate says of the middle of the turns.
struct PeerVerdict {
  double most_ratio = 0.0;
  std::optional<TurnRatios> turns;  // nothing: too few to judge

  bool passed() const { return turns && turns->median <= most_ratio; }
  /// "PASS: ...", "FAIL: ..." or why it could not be judged.
  std::string message() const;
};

/// Runs it once and adds its samples.
std::optional<model::Error> run_cyclictest(const PeerCall& call,
                                           const program::ScratchFolder& folder, Series& series);

}  // namespace tact::tools::jitter
