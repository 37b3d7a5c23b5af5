// elastic_field.h - closed-form laws over a whole surface, with relaxation: the SiteLaw of them.
//
// One law for every place, or a family of laws from soft to stiff and a coordinate kappa per vertex
// that says which: linear over each triangle, blended between neighbours k <= kappa <= k + 1,
//
//     U(d, s)  = (1 - f) U_k(d) + f U_(k+1)(d),    f = kappa(s) - k
//     dU/ds    = (U_(k+1)(d) - U_k(d)) grad kappa
//
// so the field has one potential and no stroke along the surface makes energy. Press and pull may
// have a coordinate each: U = 0 between them. A tick costs at most 2 (1 + terms) look-ups a sphere,
// whatever the mesh.
#pragma once

#include <array>
#include <span>

#include "model/relaxation.h"
#include "model/site_law.h"

namespace tact::model {

/// What an ElasticField borrows; all of it outlives the field.
struct ElasticFieldParts {
  std::span<const Law* const> curves;  // one or more, at least as stiff as the one before
  std::span<const float> coordinate;   // kappa, n vertices, 0 .. curves - 1; empty with one curve
  std::span<const float> pull_coordinate;  // the same for d < 0; empty: as coordinate
  SurfaceView surface;
  Relaxation relaxation;
};

class ElasticField final : public SiteLaw {
 public:
  explicit ElasticField(const ElasticFieldParts& parts) : parts_(parts) {}

  SiteResponse respond(const Indentation& in) RT_SAFE override;
  void leave(std::size_t sphere) RT_SAFE override { now_[sphere] = next_[sphere] = {}; }
  void advance() RT_SAFE override { now_ = next_; }
  std::size_t profile(const Indentation& in, std::span<double> ring_m) const RT_SAFE override;
  double ring_pitch_m() const RT_SAFE override { return parts_.curves[0]->ring_pitch_m(); }

 private:
  struct Blend {
    std::size_t low = 0;    // k
    double fraction = 0.0;  // f
  };
  /// One part of the potential: the law at one stretch, and what it adds along the surface.
  struct Part {
    LawResponse law;
    Vec3 slope_N{};
  };
  bool is_known(const Indentation& in) const RT_SAFE;
  std::span<const float> coordinate(double depth_m) const RT_SAFE;
  Blend blend_at(const Place& place, double depth_m) const RT_SAFE;
  Part part_at(const Place& place, double depth_m) const RT_SAFE;
  Vec3 coordinate_slope(std::uint32_t triangle, double depth_m) const RT_SAFE;

  ElasticFieldParts parts_;
  std::array<RelaxationState, kMaxSpheres> now_{}, next_{};
};

}  // namespace tact::model
