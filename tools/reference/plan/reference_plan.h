// SPDX-License-Identifier: Apache-2.0
// reference_plan.h - which cases make the reference of an organ, and how they become one file.
//
// Per site: press at every depth; pull once, since it is linear, scaled to every depth. For some
// sites also press and pull with large strain, at every depth (a pull up to 1.3 R) and on the
// coarsest mesh: it says how far linear is wrong. The mesh error of a force comes from its change
// from the next coarser level, solved at the least and the largest depth and for linear pull; a
// depth between takes that of the nearer end. Not known (linear cases at the coarsest level, ends
// without a solution) is NaN, null in the file. The error of the solver's steps is not in it: 1 %
// of a press with large strain two radii deep.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/scene/scene.h"
#include "tools/reference/plan/solve_cache.h"

namespace tact::tools::reference {

/// The deepest pull with large strain, of the tool's radius: elements at the rim of the bond that
/// stand more are too coarse to be true.
inline constexpr double kLargePull = 1.3;

/// Of edges, and of the error, from a level to the next finer one.
inline constexpr double kErrorShrink_ratio = 0.7;

/// What is left of the error at the finer level, of the force. Edges shrink by k from one level to
/// the next and the error with them (the rim of a contact is singular), so the rest of the series
/// is k / (1 - k) of the last change.
double remaining_error(double fine_N, double coarse_N, double shrink = kErrorShrink_ratio);

struct ReferencePlan {
  Organ organ;
  std::string mesh_name;
  double tool_radius_m = 0.0;
  std::vector<std::uint32_t> sites;
  std::vector<double> depths_m;                   // above 0, rising
  std::vector<std::uint32_t> large_strain_sites;  // also among sites
  int level = 2;
};

/// What a file of results says of its body.
ground_truth::SolvedBody solved_body(const Organ& organ, const std::string& mesh_name,
                                     const std::string& solver);

/// Organ, tool and sites of a scene; depths, level and large strain stay as they are by default.
model::Result<ReferencePlan> plan_of(const model::scene::Scene& scene);

/// "CalculiX 2.20, gmsh 4.8.4"; an error says what to install.
model::Result<std::string> solver_versions();

/// An error names the vertex or depth that cannot be solved.
std::optional<model::Error> check(const ReferencePlan& plan);

/// Every solve of the plan, each once.
std::vector<Indentation> cases_of(const ReferencePlan& plan);

/// Puts solved cases together; `solved` in the order of cases_of. A case with large strain may be
/// missing.
ground_truth::ReferenceData assemble(
    const ReferencePlan& plan,
    const std::vector<std::optional<ground_truth::ReferenceCase>>& solved,
    const std::string& solver);

}  // namespace tact::tools::reference
