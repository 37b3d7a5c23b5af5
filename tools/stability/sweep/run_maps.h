// SPDX-License-Identifier: Apache-2.0
// run_maps.h - from options to tables on disk, and what report/ evaluates and draws.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "tools/stability/sweep/map.h"

namespace tact::tools::stability {

struct StabilityOptions {
  std::string out{};      // folder, made if need be
  std::string letters{};  // maps to make, "abcd"
  std::string only{};     // one map by its name; empty: all of the letters
  Extent extent = Extent::kFull;
};

struct MapsRun {
  /// Each table on disk: map, rows with every digit, files, facts.
  nlohmann::json maps = nlohmann::json::array();
  std::optional<model::Error> error;  // what ended the run early; interruption() after Ctrl-C
};

MapsRun run_maps(const StabilityOptions& options);

}  // namespace tact::tools::stability
