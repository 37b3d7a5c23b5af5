// SPDX-License-Identifier: Apache-2.0
// What a scene says of a mass-spring patch, in [spring_patch].
#include <algorithm>
#include <array>

#include "model/springs/spring_patch.h"

namespace tact::model::springs {
namespace {

/// From the one table of names.
constexpr auto kIntegrators = [] {
  std::array<Choice, kIntegratorNames.size()> out{};
  std::ranges::transform(kIntegratorNames, out.begin(),
                         [](const IntegratorName& one) { return Choice{one.name, one.meaning}; });
  return out;
}();
static_assert(std::ranges::is_sorted(kIntegratorNames, std::ranges::less_equal{},
                                     &IntegratorName::integrator) &&
              kIntegratorNames.back().integrator == Integrator{kIntegratorNames.size() - 1});

}  // namespace

void visit(ParameterVisitor& v, SpringPatchParameters& p) {
  v.number("surface_stiffness_N_per_m", {0.01, 1e5}, "of a spring along an edge of the mesh",
           p.tissue.surface_stiffness_N_per_m);
  v.number("body_stiffness_N_per_m", {0.001, 1e5}, "from a vertex to its place at rest",
           p.tissue.body_stiffness_N_per_m);
  v.number("damping_time_s", {0.0, 1.0}, "tau: a surface spring k has the damping tau k",
           p.tissue.damping_time_s);
  v.number("body_damping_time_s", {0.0, 1.0}, "the same for the body springs",
           p.tissue.body_damping_time_s);
  v.number("pretension_ratio", {0.0, 0.5, kHard}, "stretch of the edges at rest: opens a cut",
           p.tissue.pretension_ratio);
  v.number("coupling_stiffness_N_per_m", {0.01, 1e5}, "of the spring between tool and vertices",
           p.coupling_stiffness_N_per_m);
  v.number("node_mass_kg", {1e-7, 1.0}, "of a vertex", p.node_mass_kg);
  v.number("working_depth_m", kDepth_m, "press and pull up to here", p.working_depth_m);
  v.count("nodes", {16, kMaxPatchNodes}, "vertices that move, nearest the contact", p.nodes);
  v.choice("integrator", kIntegrators, "how a tick is stepped", p.method.integrator);
  v.number("alpha_ratio", {0.1, 1.0, kHard}, "of midpoint-averaging; 0.375 makes energy",
           p.method.alpha, Need::kOptional);
  v.count("iterations", {1, 100}, "of implicit-euler", p.iterations, Need::kOptional);
  v.count("substeps", {1, 16}, "of a tick", p.substeps, Need::kOptional);
}

}  // namespace tact::model::springs
