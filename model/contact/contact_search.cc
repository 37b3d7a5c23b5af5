// SPDX-License-Identifier: Apache-2.0
// Which point of the surface a free sphere is nearest to: see contact.h.
#include <cmath>

#include "model/contact/contact.h"

namespace tact::model::contact {
namespace {

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
Site Contact::search(Probe& probe, double radius_m) RT_SAFE {
  constexpr double kBeside_cells = 2.0;
  const SeedGridView& seeds = scene_.seeds;
  const std::uint32_t cell = seeds.cell_of(probe.centre_m);
  if (cell != probe.cell) {
    probe.cell = cell;
    const Seeds watched = probe.candidate;
    for (std::size_t i = 0; i < watched.size(); ++i)
      probe.candidate[i] = nearer_than_seed(scene_.surface, seeds.cell[cell][i], watched,
                                            probe.centre_m, kBeside_cells * seeds.cell_m);
  }
  const Site best = walk(probe.candidate[0], probe.centre_m, radius_m);
  if (probe.candidate[1] == kNoTriangle) return best;
  const Site other = walk(probe.candidate[1], probe.centre_m, radius_m);
  return std::abs(other.distance_m) < std::abs(best.distance_m) ? other : best;
}

// Where the sheet is too far to be touched before the next cell, a few steps a tick are enough: a
// seed is no further from the nearest point than its cell is wide.
Site Contact::walk(std::uint32_t& candidate, const Vec3& p_m, double radius_m) const RT_SAFE {
  constexpr double kFar_cells = 4.0;
  constexpr int kStepsFarAway = 4;
  const double away_m = norm(a_corner(scene_.surface, candidate) - p_m) - radius_m;
  const bool is_far = away_m > kFar_cells * scene_.seeds.cell_m;
  const Site site = follow(scene_.surface, candidate, p_m, is_far ? kStepsFarAway : kMaxWalkSteps);
  candidate = site.place.triangle;
  return site;
}

}  // namespace tact::model::contact
