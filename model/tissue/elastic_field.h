// SPDX-License-Identifier: Apache-2.0
// elastic_field.h - closed-form laws over a whole surface, with relaxation: the ContactLaw of them.
//
// One law for every place, or a family of laws from soft to stiff and a coordinate kappa per vertex
// that says which: linear over each triangle, blended between neighbours k <= kappa <= k + 1,
//
//     U(d, s)  = (1 - f) U_k(d) + f U_(k+1)(d),    f = kappa(s) - k
//     dU/ds    = (U_(k+1)(d) - U_k(d)) grad kappa
//
// so the field has one potential and no stroke along the surface makes energy. Press and pull may
// have a coordinate each: U = 0 between them. An answer costs at most 2 (1 + terms) look-ups,
// for any mesh. Two contact points, s apart, couple as those of one elastic body:
//
//     MC-2   h = 1 / (pi E* |c_i - c_j|) + min(S_ij, 0) >= 0,   b = max(S_ij, 0)
//
// half-space and the organ's regular part S_ij: the mean of both points' rings of the compliance
// map, below 0 beside the held side. Sideways a contact point gives way by half-space and regular
// part, too, by another length in each direction:
//
//     MC-5   G_i = B / a_i I + S_i,   B = (2 - nu) / (4 E* (1 - nu))
//
//     G   m/N, 2 x 2, along the surface    S_i  of the map (CF-4)    a_i  radius of the contact, m
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "model/contact/contact_law.h"
#include "model/contact/smooth_surface.h"
#include "model/law/relaxation.h"
#include "model/mat3.h"

namespace tact::model::tissue {

/// S E of a vertex, tangential, symmetric, in the scene's axes: where it may sink, and held.
struct TangentTensors {
  std::array<float, 6> contact_per_m{}, held_per_m{};  // xx yy zz yz zx xy
};

/// What two contact points of one elastic body are to each other. Without a map the body is a
/// half-space.
struct ElasticNeighbours {
  double youngs_modulus_Pa = 0.0;  // E
  // E*; 0: nothing is known, contact points do not couple
  double contact_modulus_Pa = 0.0;
  double poisson_ratio = 0.5;                   // nu
  std::span<const float> ring_times_E_per_m{};  // g_j E of vertex v at [v rings + j - 1]; or empty
  std::span<const float> regular_times_E_per_m{};  // r E, where the curves are the tip's alone
  std::size_t rings = 0;
  double ring_pitch_m = 0.0;
  std::span<const TangentTensors> tangent_times_E_per_m{};  // S E of each vertex; or empty
  // For tilt(): t E of each vertex (CF-6), or of an organ that bends its compliance and slope.
  std::span<const Vec3> tilt_times_E_per_m2{};
  std::span<const contact::VertexCompliance> vertex_compliance{};
};

/// What an ElasticField borrows; all of it outlives the field.
struct ElasticFieldParts {
  std::span<const law::Law* const> curves;  // one or more, at least as stiff as the one before
  std::span<const float> coordinate;  // kappa, n vertices, 0 .. curves - 1; empty with one curve
  std::span<const float> pull_coordinate;  // the same for d < 0; empty: as coordinate
  contact::SurfaceView surface;
  law::Relaxation relaxation;
  ElasticNeighbours neighbours = {};
  /// g_j E of curve k at [k rings + j - 1], as its profile has it; empty: it has none of a map.
  std::span<const float> curve_ring_times_E_per_m{};
  bool damps = false;  // a curve depends on speed
  const law::Law* indentation_shape =
      nullptr;  // of the indentation, where the curves are springs that have none
};

class ElasticField final : public contact::ContactLaw {
 public:
  explicit ElasticField(const ElasticFieldParts& parts);

  contact::ContactLawResponse respond(const contact::Indentation& in) RT_SAFE override;
  double resistance_N(const contact::Indentation& in, double force_N) const RT_SAFE override;
  contact::ContactCoupling coupling(const contact::Indentation& a, const contact::Indentation& b,
                                    double distance_m) const RT_SAFE override;
  double stiffest_N_per_m(const contact::SurfacePoint& surface_point,
                          bool held) const RT_SAFE override;
  double relaxation_ratio() const RT_SAFE override;
  contact::TangentCompliance tangent_compliance(const contact::SurfacePoint& surface_point,
                                                bool held,
                                                const contact::Axes& axes) const RT_SAFE override;
  void leave(std::size_t sphere) RT_SAFE override { now_[sphere] = next_[sphere] = {}; }
  void advance() RT_SAFE override {
    // bound: spheres
    if (parts_.relaxation.terms() > 0) std::copy_n(next_.begin(), spheres_, now_.begin());
  }
  std::size_t profile(const contact::Indentation& in,
                      std::span<double> ring_m) const RT_SAFE override;
  Vec3 tilt(const contact::Indentation& in) const RT_SAFE override;
  double ring_pitch_m() const RT_SAFE override {
    return parts_.indentation_shape != nullptr ? parts_.indentation_shape->ring_pitch_m()
                                               : parts_.curves[0]->ring_pitch_m();
  }

 private:
  struct Blend {
    std::size_t low = 0;    // k
    double fraction = 0.0;  // f
  };
  /// One part of the potential: the law at one stretch, and dU/dkappa.
  struct Part {
    law::LawResponse law;
    double coordinate_slope_J = 0.0;
  };
  /// grad kappa of the triangle under a sphere, of press and of pull.
  struct Gradient {
    std::uint32_t triangle = contact::kNoTriangle;
    std::array<Vec3, 2> per_m{};
  };
  bool is_known(const contact::Indentation& in) const RT_SAFE;
  std::span<const float> coordinate(double depth_m) const RT_SAFE;
  Blend blend_at(const contact::SurfacePoint& surface_point, double depth_m) const RT_SAFE;
  Part part_at(const contact::SurfacePoint& surface_point, double depth_m) const RT_SAFE;
  double regular_m_per_N(const contact::SurfacePoint& surface_point,
                         double distance_m) const RT_SAFE;
  void add_organ(const contact::Indentation& in, std::span<double> ring_m) const RT_SAFE;
  void report_own_rings(const contact::Indentation& in, std::span<double> ring_m) const RT_SAFE;
  Vec3 coordinate_slope(std::uint32_t triangle, double depth_m) const RT_SAFE;
  const Gradient& gradient_at(const contact::Indentation& in) RT_SAFE;

  ElasticFieldParts parts_;
  std::vector<double> stiffest_N_per_m_;  // of each curve
  std::array<law::RelaxationState, contact::kMaxSpheres> now_{}, next_{};
  std::size_t spheres_ = 0;  // seen so far
  std::array<Gradient, contact::kMaxSpheres> gradient_{};
};

}  // namespace tact::model::tissue
