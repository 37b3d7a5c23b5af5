// SPDX-License-Identifier: Apache-2.0
// chart_peers.h - other ways to make an organ feel soft, given the same mesh, sites, tip and truth.
//
//     fem             the whole organ as quadratic tetrahedra, one solve a tick with a factor made
//                     beforehand; E and nu of the scene
//     spring_mesh     all vertices and edges of the surface as masses and springs, implicit Euler
//     bullet_surface  Bullet's soft body of the same surface that remembers its shape
//     bullet_volume   Bullet's soft body of the same surface filled with tetrahedra
//
// Those without E are fitted first: their mean force at the reference's press nearest to 5 mm is
// the reference's. All are held where the scene says, at rest under no load, at the scene's rate.
#pragma once

#include <vector>

#include "tools/chart/measure/measure.h"
#include "tools/chart/subject/subject.h"
#include "tools/chart/subject/variants.h"

namespace tact::tools::chart {

constexpr double kDensity_kg_per_m3 = 1060.0;
constexpr double kCoupling_N_per_m = 300.0;  // q, of masses on springs without a patch in the scene

/// What a peer is made of; `scene` and `cases` outlive it.
struct PeerInput {
  const model::scene::Scene& scene;
  const std::vector<ProbeCase>& cases;
};

model::Result<std::unique_ptr<Subject>> make_fem_peer(const PeerInput& input, double edge_m);
model::Result<std::unique_ptr<Subject>> make_spring_peer(const PeerInput& input, int iterations);
model::Result<std::unique_ptr<Subject>> make_bullet_peer(const PeerInput& input, bool volume,
                                                         int iterations);

/// Any of them.
model::Result<std::unique_ptr<Subject>> make_peer(const PeerInput& input, const Variant& variant);

/// Vertices of the surface in the box that the scene holds.
std::vector<std::uint32_t> held_vertices(const model::scene::Scene& scene);

/// The press nearest to 5 mm of every site, those held out aside: what peers are fitted to.
std::vector<ProbeCase> fit_cases(const std::vector<ProbeCase>& cases);
/// Mean over them of the subject's force, and of the reference's.
double mean_force_N(Subject& subject, const std::vector<ProbeCase>& cases);
double mean_reference_N(const std::vector<ProbeCase>& cases);

}  // namespace tact::tools::chart
