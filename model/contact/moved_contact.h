// SPDX-License-Identifier: Apache-2.0
// moved_contact.h - contact of a tool's spheres with an organ that they displace, tick by tick.
//
// State of each sphere in contact: a surface point s (the god object), and y, z, v of the last tick
// (moved_organ.h). In each tick the surface points follow y: without friction completely, with
// friction by the part outside of Coulomb's cone, held not at all. At most kMaxNewtonSteps Newton
// steps on y solve ML-5; a residual below 10 um is left to the next tick. Otherwise the surface
// points are kept where these steps left them, and ML-5 is solved for them: I + G K is well posed,
// and the force is the slope of W there. If that fails, too, the tissue keeps its last state, and
// each sphere its last force without the part along its motion, which gives no energy.
//
// Sliding may add a little energy, as SF-1 to SF-4 are a potential only up to third order. It is
// permitted up to the energy that slides lost earlier (at most 5 % of W) plus 2 % of W. The excess
// is dissipated:
//
//     ML-9   brake_i = -rho |P_i| dc_i / |dc_i|,   rho = excess / sum |P_i| |dc_i|
//
//     P_i of ML-6, N   dc_i displacement in this tick, m   excess  energy above that limit, J
#pragma once

#include <array>

#include "model/contact/contact_scene.h"
#include "model/contact/moved_organ.h"
#include "model/contact/organ_contact.h"

namespace tact::model::contact {

/// An organ with large displacements. All data referred to must outlive the contact.
struct BendingOrgan {
  SmoothSurface surface;
  double contact_modulus_Pa = 0.0;  // E*
  double poisson_ratio = 0.5;
  double held_N_per_m = 0.0;  // tangential stiffness of a bonded disc, 1/c_side of CT-6
  double range_m = 0.0;       // largest displacement of the organ; beyond: saturated
  double chord_ratio = kChord_ratio;
  law::Creep creep;
};

/// How the last tick was solved.
struct MovedContactStatus {
  int steps = 0;          // Newton steps, total
  bool is_fixed = false;  // solved with fixed surface points
  bool is_solved = true;
};

class MovedContact final : public OrganContact {
 public:
  /// In a scene without a bending organ no other function may be called.
  explicit MovedContact(const ContactScene& scene);

  void reset() RT_SAFE override;
  void begin(const Sphere& sphere, const ContactPoint& contact_point,
             double explained_m) RT_SAFE override;
  void leave(std::size_t sphere) RT_SAFE override;
  Step step(Sphere& sphere, const Vec3& moved_m) RT_SAFE override;
  void move(const Sphere& sphere) RT_SAFE override;
  bool must_end(Sphere& sphere) RT_SAFE override;
  double cut_to_law_m(std::size_t sphere) RT_SAFE override;
  void add_depth_offset(std::size_t sphere, double depth_m) RT_SAFE override;
  void respond() RT_SAFE override;
  double pull_N(std::size_t sphere) const RT_SAFE override;
  bool release(std::size_t sphere) RT_SAFE override;
  bool hold(std::size_t sphere) RT_SAFE override;
  void finish() RT_SAFE override {}
  bool is_solved() const RT_SAFE override { return status_.is_solved; }
  OrganForce report(const Sphere& sphere, SphereContact& reported) const RT_SAFE override;
  void advance() RT_SAFE override;

  /// nullptr if the sphere does not touch.
  const OrganSphere* find(std::size_t sphere) const RT_SAFE;
  const MovedOrgan& organ() const RT_SAFE { return organ_; }
  const MovedContactStatus& status() const RT_SAFE { return status_; }

 private:
  OrganSphere* at(std::size_t sphere) RT_SAFE;
  bool is_beyond(const OrganSphere& sphere) const RT_SAFE;
  void couple() RT_SAFE;
  void stiffen(OrganSphere& sphere) RT_SAFE;
  void follow_feet() RT_SAFE;
  bool follow_foot(OrganSphere& sphere) const RT_SAFE;
  bool solve_sliding() RT_SAFE;
  bool solve_fixed() RT_SAFE;
  void keep_last_state() RT_SAFE;
  void brake() RT_SAFE;

  ContactScene scene_;
  MovedOrgan organ_;
  std::array<OrganSphere, kMaxSpheres> before_;  // of the last tick
  bool is_changed_ = true;  // more than the centres has changed since the last solution
  bool is_nearly_ = false;  // the last solution is not converged; the next tick continues
  double stored_J_ = 0.0;   // ML-7 of the last solution
  double tank_J_ = 0.0;     // energy lost so far, at most a share of W; negative: added
  MovedContactStatus status_;
};

}  // namespace tact::model::contact
