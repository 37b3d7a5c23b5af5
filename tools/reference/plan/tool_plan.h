// SPDX-License-Identifier: Apache-2.0
// tool_plan.h - where the whole tool is pressed, and how the solves become one file.
//
// The hand's own site comes first, as its stroke presses it, then the middle and the end of each
// of its slides in contact. Then places that no fit has used, chosen by a rule that nobody can
// bend: of all vertices where
//
//     the surface looks towards the hand   outward normal within 60 degrees of the hand's way out
//     the whole tool finds tissue          along the tool's way each sphere's axis meets it within
//                                          half a radius of the same height
//     the tissue is deep enough            twice the deepest press along every axis
//     nothing is held nearby               no held triangle's corner within three radii and the
//                                          deepest press
//
// each time the one farthest from the hand's site, from the places chosen before and from the
// [[reference_site]]s that a law is fitted on; of equal ones the least number. The tool comes along
// the inward normal and first touches at depth 0.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/scene/scene.h"
#include "tools/reference/plan/solve_cache.h"

namespace tact::tools::reference {

inline constexpr std::size_t kUnseenPlaces = 6;

struct ToolPlan {
  Organ organ;
  std::string mesh_name;
  std::vector<model::contact::ProbeSphere> sphere;
  std::vector<ground_truth::ToolPoint> places;  // without cases
  std::vector<double> depths_m;                 // above 0, rising
  int level = 2;
};

/// `vertices`: instead of those that the rule chooses; `depths_m`: empty: 1, 2, 5 and 10 mm. An
/// error says what the scene lacks or where the tool cannot be pressed.
model::Result<ToolPlan> tool_plan_of(const model::scene::Scene& scene,
                                     const std::vector<std::uint32_t>& vertices,
                                     const std::vector<double>& depths_m, int level);

/// Adds to each place the vertices that the picture shows pressed: within 30 mm, facing the tool.
void ask_for_skin(ToolPlan& plan);

/// Every solve of the plan, each once: all places at the level, then one level coarser.
std::vector<ToolPress> presses_of(const ToolPlan& plan);

/// Puts solves together; `solved` in the order of presses_of.
ground_truth::ToolReference assemble(const ToolPlan& plan,
                                     const std::vector<std::vector<ground_truth::ToolCase>>& solved,
                                     const std::string& solver);

}  // namespace tact::tools::reference
