// SPDX-License-Identifier: Apache-2.0
// sideways_plan.h - how stiff the organ is along its surface: a round patch dragged as one piece.
//
// Per site: two directions at right angles, for a patch as wide as the tool that is held at its
// height, and for patches of a half and of the whole radius that may rise and sink, as a sphere
// leaves them. The error of the mesh is the rest of a series whose last step is the difference from
// the next coarser level.
#pragma once

#include <string>
#include <vector>

#include "tools/reference/plan/reference_plan.h"

namespace tact::tools::reference {

struct SidewaysCase {
  std::uint32_t vertex = 0;
  model::Vec3 along{};  // unit, tangential
  bool held = false;
  double contact_radius_m = 0.0;
  double stiffness_N_per_m = 0.0;
  double error_ratio = 0.0;  // of the mesh
};

struct SidewaysReference {
  ground_truth::SolvedBody body;
  std::vector<SidewaysCase> cases;
};

/// Every solve, each once: all cases at the level, then one level coarser.
std::vector<Indentation> sideways_cases(const ReferencePlan& plan);

/// `solved` in the order of sideways_cases.
SidewaysReference assemble_sideways(
    const ReferencePlan& plan,
    const std::vector<std::optional<ground_truth::ReferenceCase>>& solved,
    const std::string& solver);

/// JSON, one case a line.
std::string sideways_text(const SidewaysReference& data);

}  // namespace tact::tools::reference
