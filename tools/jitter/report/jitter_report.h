// SPDX-License-Identifier: Apache-2.0
// jitter_report.h - a measurement as text for people, as JSON for machines, for `compare` and for
// jitter_page.py, which makes picture and page of it, and as a row of tools/deploy/PCS.md.
//
// A percentile is reported where at least one sample lies beyond it, else it is "-" or null: of 10
// 000 samples p99.99 is the last. The largest of a run is reported with its tick and its time, and
// is no bound: no run of any length shows the worst case.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/jitter/run/jitter_run.h"
#include "tools/jitter/run/peer.h"

namespace tact::tools::jitter {

struct Share {
  const char* name;
  double value;
};
inline constexpr std::array<Share, 6> kShares{{{"p50", 0.5},
                                               {"p90", 0.9},
                                               {"p99", 0.99},
                                               {"p99.9", 0.999},
                                               {"p99.99", 0.9999},
                                               {"p99.999", 0.99999}}};

struct NamedSeries {
  std::string key;    // of the JSON
  std::string title;  // for people
  const Series* series;
};

/// Those that this run has measured, in the order of a tick.
std::vector<NamedSeries> series_of(const JitterResult& result);
/// Wake-up at p99.9 over the peer's; nothing where one of them has too few samples.
std::optional<double> ratio_to_peer(const JitterResult& result);
/// The same as a clause, with the middle of the turns.
std::string compare_with_peer(const JitterResult& result);

/// Nothing without a gate.
std::optional<PeerVerdict> check_peer(const JitterResult& result);
/// The run in one message that begins with its outcome, for the top of a report.
struct Outcome {
  const char* verdict;  // pass, fail, part
  std::string message;
};
Outcome outcome_of(const JitterResult& result);
/// Is this PC good enough for the rate, and why?
Outcome answer_of(const JitterResult& result);
/// For main(): 0 good, 1 a fault or a gate that fails, 2 a gate that could not be evaluated.
int exit_status(const JitterResult& result);

/// One message about the run: what, how long, where, how many late.
std::string make_headline(const JitterResult& result);
/// Seconds since the first tick.
double seconds_into(const JitterResult& result, std::int64_t at_ns);
/// Microseconds with three digits, "-" for nothing.
std::string in_us(std::optional<std::uint64_t> duration_ns);

std::string make_summary(const JitterResult& result);
nlohmann::json to_json(const JitterResult& result, const std::string& command);

inline constexpr const char* kSubmissionHead =
    "| CPU, cores | kernel | settings | wake-up p99.9, us | deadline to force p99.9, us | largest, "
    "us | duration, s |\n|---|---|---|---|---|---|---|\n";

/// How a row of this PC begins: a file that begins otherwise is none, or another PC's.
std::string submission_beginning();

/// A row of that table with its line end. Neither the PC's name nor its user's is in it.
std::string make_submission(const JitterResult& result);

}  // namespace tact::tools::jitter
