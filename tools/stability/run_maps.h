// run_maps.h - from options to tables, findings and pictures on disk.
#pragma once

#include <string>
#include <vector>

#include "tools/stability/map.h"

namespace tact::tools {

struct StabilityOptions {
  std::string out{};                 // folder, made if need be
  std::string letters{};             // maps to make, "abcd"
  std::string only{};                // one map by its name; empty: all of the letters
  Shard shard{};                     // our part of every map
  std::vector<std::string> merge{};  // CSVs of shards instead of a run
  Grid grid = Grid::kFull;
  bool draw_pictures = true;
};

/// What became of one map.
struct MapReport {
  std::string name;
  std::size_t rows = 0;
  std::vector<Finding> findings;  // none for a shard: a part proves nothing
  std::vector<std::string> files;
};

/// An error if something could not be read, written or drawn, or if Ctrl-C came; the tables that
/// are named in no report were not written.
model::Result<std::vector<MapReport>> run_maps(const StabilityOptions& options);

}  // namespace tact::tools
