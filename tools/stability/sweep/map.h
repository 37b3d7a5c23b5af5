// SPDX-License-Identifier: Apache-2.0
// map.h - one map of tact-lab stability: a table of independent cells, what it shows, its picture.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "tools/report/plot.h"
#include "tools/report/table.h"

namespace tact::tools::stability {

/// A message about a whole table that must be true, and its numbers by name for --json.
struct Finding {
  bool holds = false;
  std::string message;
  std::map<std::string, double> numbers = {};
};

/// The least and the largest of some ratios.
struct Spread {
  double low = 1e9, high = 0.0;
  void add(double ratio) { low = std::min(low, ratio), high = std::max(high, ratio); }
  /// "claim: measured 0.953 to 1.021 of it"
  Finding within(double least, double most, const std::string& claim) const {
    return {low > least && high < most,
            fmt::format("{}: measured {:.3f} to {:.3f} of it", claim, low, high)};
  }
};

enum class Extent { kFull, kQuick };

struct Map {
  char letter = '?';  // of --map
  const char* name = "";
  const char* purpose = "";  // for --help
  std::size_t (*jobs)(Extent extent) = nullptr;
  report::Row (*run)(std::size_t job, Extent extent) = nullptr;
  std::vector<Finding> (*check)(const report::Table& table) = nullptr;
  report::Plot plot{};  // of the map's name; none without a script
  report::Variables (*variables)(Extent extent) = nullptr;
};

/// All maps, in the order of their letters.
std::vector<Map> all_maps();

Map integrator_map();
Map law_limit_map();
Map law_line_map();
Map loop_map();
Map law_loop_map();
Map delta_loop_map();
Map tick_map();
Map loss_map();

}  // namespace tact::tools::stability
