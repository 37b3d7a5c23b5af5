// SPDX-License-Identifier: Apache-2.0
// fit_csv.h - force over depth, or over time at held depth, as a bench writes it: CSV.
//
//     # a comment                                 depth_m  press positive, pull negative
//     depth_m,force_N,site,u_0_m,u_1_m            force_N  of the sign of the depth
//     radius_m,,,0.000,0.004                      site     optional; a vertex of the organ for laws
//     0.001,0.05,1714,0.001,0.0004                         that differ from place to place
//     0.002,0.12,1714,0.002,0.0009                u_k_m    optional; the row radius_m says where
//
// Columns may have other names and units; others than these are not read. Every error names the
// file and the line.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "model/result.h"
#include "tools/fit/fit_data.h"
#include "tools/fit/fit_prony.h"

namespace tact::tools::fit {

struct BenchColumns {
  std::string depth = "depth_m", force = "force_N", time = "time_s";
  double depth_unit_m = 1.0;  // what 1 in that column is
  double force_unit_N = 1.0;
  double time_unit_s = 1.0;
  double deepest_m = std::numeric_limits<double>::infinity();  // deeper rows are left out
};

/// Sites have no place yet; `held_out` names those that are only evaluated.
model::Result<FitData> read_bench_csv(const std::string& path, const BenchColumns& columns,
                                      const std::vector<std::string>& held_out);

/// Times must rise; the first row is the moment of the step.
model::Result<std::vector<HeldForce>> read_relaxation_csv(const std::string& path,
                                                          const BenchColumns& columns);

}  // namespace tact::tools::fit
