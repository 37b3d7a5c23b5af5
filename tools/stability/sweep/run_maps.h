// SPDX-License-Identifier: Apache-2.0
// run_maps.h - from options to tables, findings and pictures on disk.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/stability/sweep/map.h"

namespace tact::tools::stability {

struct StabilityOptions {
  std::string out{};      // folder, made if need be
  std::string letters{};  // maps to make, "abcd"
  std::string only{};     // one map by its name; empty: all of the letters
  Extent extent = Extent::kFull;
  bool draw_plots = true;
};

/// What became of one map.
struct MapReport {
  std::string name;
  std::size_t rows = 0;
  std::vector<Finding> findings;
  std::vector<std::string> files;
};

struct MapsRun {
  std::vector<MapReport> reports;     // what is on disk, finished
  std::optional<model::Error> error;  // what ended the run early; interruption() after Ctrl-C
};

MapsRun run_maps(const StabilityOptions& options);

}  // namespace tact::tools::stability
