// SPDX-License-Identifier: Apache-2.0
// map.h - one map of tact-lab stability: a table of independent cells.
//
// What it must show and its picture: findings.py and NAME.gp in report/.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "tools/report/table.h"

namespace tact::tools::stability {

enum class Extent { kFull, kQuick };

struct Map {
  char letter = '?';  // of --map
  const char* name = "";
  const char* purpose = "";  // for --help
  std::size_t (*jobs)(Extent extent) = nullptr;
  report::Row (*run)(std::size_t job, Extent extent) = nullptr;
  nlohmann::json (*facts)() = nullptr;  // what report/ needs and no column says
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
