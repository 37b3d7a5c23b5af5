// peer.h - cyclictest of rt-tests beside the loop: the same priority, core, period and load, in
// slices that take turns with the loop's, so that both meet the same weather.
#pragma once

#include <string>
#include <vector>

#include "model/result.h"
#include "tools/common/run_program.h"
#include "tools/jitter/tick_times.h"

namespace tact::tools {

struct PeerCall {
  int core = 0;
  int priority = 80;
  std::int64_t period_ns = 1'000'000;
  double duration_s = 1.0;
};

/// The arguments of cyclictest; its JSON goes to `json_path`.
std::vector<std::string> cyclictest_arguments(const PeerCall& call, const std::string& json_path);

/// Adds what cyclictest has written to a series. Its buckets are whole microseconds; each counts at
/// its upper edge, as ours do. Values beyond its histogram are known by number and largest alone:
/// all of them count as the largest.
std::optional<model::Error> add_cyclictest(const std::string& json, Series& series);

/// Runs it once and adds its samples.
std::optional<model::Error> run_cyclictest(const PeerCall& call, const ScratchFolder& folder,
                                           Series& series);

}  // namespace tact::tools
