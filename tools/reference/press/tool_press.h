// SPDX-License-Identifier: Apache-2.0
// tool_press.h - all spheres of a tool pressed into an organ together: one rigid body, no friction.
//
// Linear elastic, as indentation.h: pressure acts along the skin's inward normal m, by which the
// tissue gives way, and across it the tissue slides freely. A load along the way would drag faces
// that lean against it: 10 % at a rim. Which of it touches is not known beforehand, and each sphere
// changes it for the others, so it is found: pressure is linear over each face of the skin,
//
//     p(x) = sum_v p_v h_v(x)                         h_v hat of the corner v
//     C_vw = int h_v u^w . m dA                       u^w under the pressure h_w
//     g_v  = int h_v (d + o(x)) c dA                  o how far the tool reaches beyond x at d = 0
//     F    = sum_v p_v int h_v c dA                   along the way;   c = m . way
//
// and p is that of active_set.h. C comes from one factored organ (model/fem/linear_solver.h), and
// every depth d from the same C. o(x) = max over the spheres of c + sqrt(R^2 - rho^2) - s, c and s
// where centre and x lie along the way, rho the distance of x from the sphere's axis. m, N, Pa.
#pragma once

#include <string>
#include <vector>

#include "tools/ground_truth/tool_reference.h"
#include "tools/reference/press/indentation.h"

namespace tact::tools::reference {

struct RigidSphere {
  model::Vec3 centre_m{};  // at depth 0, in the mesh's own frame
  double radius_m = 0.0;
};

struct ToolPress {
  model::Vec3 direction{};  // of the way, unit, into the tissue
  std::vector<RigidSphere> sphere;
  std::vector<double> depths_m;       // above 0, rising
  std::vector<std::uint32_t> skin{};  // vertices of the organ's surface whose way is wanted
  int level = 2;
};

/// The mesh for a level: edges in proportion to the distance from the nearest sphere's tip.
ground_truth::EdgeLengths edge_lengths(const Organ& organ, const ToolPress& what);

/// How far the tool reaches beyond a point at depth 0, m, and which sphere does; below every
/// sphere's side: minus infinity.
struct Reach {
  double beyond_m = 0.0;
  std::size_t sphere = 0;
};
Reach reach_beyond(const ToolPress& what, const model::Vec3& point_m);

/// Meshes and solves once for all depths. The error ratios are left at 0: they take two levels.
model::Result<std::vector<ground_truth::ToolCase>> solve(const Organ& organ, const ToolPress& what);

}  // namespace tact::tools::reference
