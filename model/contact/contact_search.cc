// SPDX-License-Identifier: Apache-2.0
// Which point of the surface a free sphere is nearest to: see contact.h.
#include <cmath>
#include <limits>

#include "model/contact/contact.h"

namespace tact::model::contact {
namespace {

// One corner stands for its triangle: from a record that the walk reads next.
Vec3 a_corner(const SurfaceView& s, std::uint32_t triangle) RT_SAFE {
  return s.record[triangle].corner_m[0];
}

// Of the watched triangles the one that lies nearer than the seed, beside it and on the same sheet;
// else the seed. On a fine mesh the way from a seed to the nearest point is long, and in no cache.
std::uint32_t nearer_than_seed(const SurfaceView& s, std::uint32_t seed, const Seeds& watched,
                               const Vec3& p_m, double beside_m) RT_SAFE {
  std::uint32_t best = seed;
  for (const std::uint32_t t : watched)
    if (seed != kNoTriangle && t != kNoTriangle &&
        dot(s.record[t].normal, s.record[seed].normal) > 0.0 &&
        norm(a_corner(s, t) - a_corner(s, seed)) < beside_m &&
        norm(a_corner(s, t) - p_m) < norm(a_corner(s, best) - p_m))
      best = t;
  return best;
}

}  // namespace

// A free probe watches the two sheets that its cell names; one in contact follows its own site.
// Where a sheet is too far to be touched before the next cell, a few steps a tick are enough: a
// seed is no further from the nearest point than its cell is wide.
Site Contact::search(Probe& probe, double radius_m) RT_SAFE {
  // Chosen, in cells of the grid: the walk of a far sheet has some ticks until the sphere is there.
  constexpr double kBeside_cells = 2.0, kFar_cells = 4.0;
  constexpr int kStepsFarAway = 4;
  const SeedGridView& seeds = scene_.seeds;
  const std::uint32_t cell = seeds.cell_of(probe.centre_m);
  const Seeds watched = probe.candidate;
  Site best;
  best.distance_m = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < watched.size(); ++k) {
    std::uint32_t& candidate = probe.candidate[k];
    // Only where the cell changes: else the walk goes on from where it was.
    if (cell != probe.cell)
      candidate = nearer_than_seed(scene_.surface, seeds.cell[cell][k], watched, probe.centre_m,
                                   kBeside_cells * seeds.cell_m);
    if (candidate == kNoTriangle) continue;
    const double away_m = norm(a_corner(scene_.surface, candidate) - probe.centre_m) - radius_m;
    const bool is_far = away_m > kFar_cells * seeds.cell_m;
    const Site site =
        follow(scene_.surface, candidate, probe.centre_m, is_far ? kStepsFarAway : kMaxWalkSteps);
    candidate = site.place.triangle;
    // By its size: from inside the body both sheets have a distance below zero.
    if (std::abs(site.distance_m) < std::abs(best.distance_m)) best = site;
  }
  probe.cell = cell;
  return best;
}

}  // namespace tact::model::contact
