// SPDX-License-Identifier: Apache-2.0
// linear_places.h - the places of a linear reference that a solution at finite strain contradicts.
//
//     |F_linear / F_finite - 1| > 3 %  at one of the depths that both have: the place is dropped
#pragma once

#include <string>
#include <vector>

#include "model/result.h"
#include "tools/ground_truth/tool_reference.h"

namespace tact::tools::ground_truth {

inline constexpr double kMaxLinearError_ratio = 0.03;

/// A place that was dropped, by its largest error.
struct DroppedPlace {
  std::string place;
  double depth_m = 0.0;
  double linear_error_ratio = 0.0;  // F_linear / F_finite - 1
};

/// Keeps the other places, and those that `finite` does not have. Both fit one scene
/// (reference_fits.h). Error: nothing could be compared, or no place is left.
model::Result<std::vector<DroppedPlace>> drop_contradicted(ToolReference& linear,
                                                           const ToolReference& finite);

}  // namespace tact::tools::ground_truth
