// SPDX-License-Identifier: Apache-2.0
// reference_presses.h - the whole tool of a scene held against presses that were solved, as
// tests/data/reference/liver_finite_strain.json: where contact is with the organ as it is moved.
//
// The reference has no friction and does not relax; so is the scene here.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "model/result.h"
#include "model/scene/scene.h"

namespace tact::tools::sweep {

/// How far the force along the way is off, from 1 mm on.
struct ReferencePress {
  std::string place;
  std::vector<std::pair<double, double>> off_ratio;  // depth, m, and of the force there
  double worst_ratio = 0.0;                          // of the force along the way, with its sign
  double worst_depth_m = 0.0;                        // where
  double worst_jaw_ratio = 0.0;  // of one sphere, by the force of the whole tool
};

/// An error names the file, the place and what it lacks.
model::Result<std::vector<ReferencePress>> press_reference(const model::scene::Scene& scene,
                                                           const std::string& path);
std::string text_of(const std::vector<ReferencePress>& presses);
std::string json_of(const std::vector<ReferencePress>& presses);

}  // namespace tact::tools::sweep
