// SPDX-License-Identifier: Apache-2.0
// condensation.h - the linear elastic organ reduced to what its surface tells a tool:
// ComplianceMap.
//
// For every vertex of the surface three unit loads (normal and two tangential) over a Hertz patch
// of radius a0 (hertz_load.h), one solve each with the factored organ (linear_solver.h), at E = 1
// Pa:
//
//     C_pq  = sum_a w_a e_p . u_a^(q)           compliance as the patch feels it, m/N
//     r E   = C_nn - 3 / (5 E* a0)              the rest likewise with C_t; see compliance_map.h
//     g_j E = mean over the ring j of  n . u^(n) - u_half(rho)
//
// Ring j gathers the nodes of the skin at straight distance rho from the vertex that look its way,
// weighted by a hat that reaches one pitch to either side. Elements near the surface should be no
// longer than about a0 / 1.6, inside the body too: flat elements behind a fine surface make r too
// small. Offline only.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "model/fem/elasticity.h"
#include "model/fem/tet_mesh.h"
#include "model/mesh/mesh.h"
#include "model/result.h"
#include "model/tissue/compliance_map.h"

namespace tact::model::fem {

/// Calls work(job, its equal part of `results`) for every job; the jobs may run in processes of
/// their own. An error if one of them ended early, or Ctrl-C did.
using Work = std::function<void(std::size_t job, std::span<float> result)>;
using RunJobs =
    std::function<std::optional<Error>(std::size_t jobs, std::span<float> results, const Work&)>;
std::optional<Error> one_after_the_other(std::size_t jobs, std::span<float> results,
                                         const Work& work);

struct CondensationSettings {
  double poisson_ratio = 0.0;
  Vec3 fixed_min_m{}, fixed_max_m{};  // skin triangles with all corners in this box are held
  std::vector<Lump> lumps{};
  double patch_radius_m = 0.0;  // a0
  double ring_pitch_m = 0.0;
  std::size_t rings = 0;
  RunJobs run_jobs = one_after_the_other;
};

/// `body` fills `surface`: its first nodes are the surface's vertices, in order.
Result<tissue::ComplianceMap> condense(const TetMesh& body, const contact::SurfaceView& surface,
                                       const CondensationSettings& settings);

}  // namespace tact::model::fem
