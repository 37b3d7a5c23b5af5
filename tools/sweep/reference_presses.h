// SPDX-License-Identifier: Apache-2.0
// reference_presses.h - the whole tool of a scene held against solved presses, as
// tests/data/reference/finite_strain_liver.json: where contact is with the organ as it is moved.
//
// The reference has no friction and does not relax; so is the scene here.
#pragma once

#include <string>
#include <vector>

#include "model/result.h"
#include "model/scene/scene.h"

namespace tact::tools::sweep {

/// How far the force along the way is off, 1 to 10 mm from the first touch.
struct ReferencePress {
  std::string place;
  double worst_ratio = 0.0;      // of the force along the way, with its sign
  double worst_depth_m = 0.0;    // where
  double worst_jaw_ratio = 0.0;  // of one sphere, by the force of the whole tool
};

/// An error names the file, the place and what it lacks.
model::Result<std::vector<ReferencePress>> press_reference(const model::scene::Scene& scene,
                                                           const std::string& path);
std::string text_of(const std::vector<ReferencePress>& presses);
std::string json_of(const std::vector<ReferencePress>& presses);

}  // namespace tact::tools::sweep
