// SPDX-License-Identifier: Apache-2.0
// moved_contact.h - the spheres of one tool on one moved organ, tick by tick.
//
// State of each sphere that touches: a surface point s (the god object), and y, t, v of the last
// tick (moved_organ.h). Each tick the surface points follow y: without friction all the way, with
// friction by what Coulomb's cone does not hold, held not at all. At most kMaxNewtonSteps on y
// solve ML-5; what is left below 10 um is left to the next tick. If they do not end, the surface
// points stay where these steps left them, and ML-5 is solved for these: I + G K is well posed, and
// the force is the slope of W there. If that fails too, the tissue stays as it was, and each sphere
// has its last force without what of it goes along its movement: this gives no energy.
//
// A slide may make a little energy, as SF-1 to SF-4 are one potential up to their third order only.
// Energy that slides lost earlier (at most 5 % of W) and 2 % of W are set off against it. What is
// made beyond is dissipated:
//
//     ML-9   brake_i = -rho F_i dc_i / |dc_i|,   rho = excess / sum F_i |dc_i|
//
//     F_i |f_i| of ML-6, N   dc_i movement in this tick, m   excess  energy made beyond that, J
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "model/contact/contact_scene.h"
#include "model/contact/moved_organ.h"
#include "model/contact/organ_contact.h"

namespace tact::model::contact {

/// An organ that bends far. What it refers to must outlive the contact.
struct BendingOrgan {
  SmoothSurface surface;
  double contact_modulus_Pa = 0.0;  // E*
  double poisson_ratio = 0.5;
  double held_N_per_m = 0.0;  // tangential stiffness of a bonded disc, 1/c_side of CT-6
  double range_m = 0.0;       // moved farther than this, it is beyond its law
  double chord_ratio = kChord_ratio;
  law::Creep creep;
};

/// What the last tick took.
struct MovedContactStatus {
  int steps = 0;          // of Newton, all together
  bool is_fixed = false;  // solved with its surface points where they were
  bool is_solved = true;
};

class MovedContact final : public OrganContact {
 public:
  /// Of a scene without an organ that bends: never to be called.
  explicit MovedContact(const ContactScene& scene);

  void reset() RT_SAFE override;
  void begin(const Sphere& sphere, const ContactPoint& contact_point,
             double paid_m) RT_SAFE override;
  void leave(std::size_t sphere) RT_SAFE override;
  Step step(Sphere& sphere, const Vec3& moved_m) RT_SAFE override;
  void move(const Sphere& sphere) RT_SAFE override;
  bool must_let_go(Sphere& sphere) RT_SAFE override;
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

  /// nullptr: it does not touch.
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
  bool is_changed_ = true;  // something beside the centres, since the last answer
  bool is_nearly_ = false;  // the last answer leaves work for the next tick
  double stored_J_ = 0.0;   // ML-7 of the last answer
  double tank_J_ = 0.0;     // lost so far, at most a share of W; below 0: made
  MovedContactStatus status_;
};

}  // namespace tact::model::contact
