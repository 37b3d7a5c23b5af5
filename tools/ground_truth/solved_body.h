// SPDX-License-Identifier: Apache-2.0
// solved_body.h - the elastic body that every file of tact-lab reference is about.
#pragma once

#include <string>

#include "model/types.h"

namespace tact::tools::ground_truth {

struct SolvedBody {
  std::string mesh;       // file name
  std::string mesh_hash;  // of vertices and triangles, 16 hex digits
  std::string solver;
  double youngs_modulus_Pa = 0.0;
  double poisson_ratio = 0.0;
  model::Vec3 fixed_min_m{}, fixed_max_m{};  // triangles with all corners in this box are held
};

}  // namespace tact::tools::ground_truth
