// SPDX-License-Identifier: Apache-2.0
// moved_contact.h - the spheres of one tool on one moved organ, tick by tick. Not yet used by
// Contact.
//
// State: a surface point s for each sphere (the god object), and y, t, v of the last tick
// (moved_organ.h). Each tick the surface points follow y: without friction all the way, with
// friction by what Coulomb's cone does not hold, held not at all. At most kMaxNewtonSteps on y
// solve ML-5. If they do not end, the surface points stay, and ML-5 is solved for these: I + G K is
// well posed, and the force is the slope of W there. If that fails too, the tissue stays as it was,
// and each sphere has its last force without what of it goes along its movement: this gives no
// energy.
//
// A slide may make a little energy, as SF-1 to SF-4 are one potential up to their third order only.
// What was lost before compensates for it, and a share of W is tolerated. Beyond, each force
// resists its movement until the excess is dissipated:
//
//     ML-9   brake_i = -rho F_i dc_i / |dc_i|,   rho = excess / sum F_i |dc_i|
//
//     F_i |f_i| of ML-6, N   dc_i movement in this tick, m   excess  energy made beyond that, J
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "model/contact/contact.h"
#include "model/contact/moved_organ.h"
#include "model/contact/site_law.h"
#include "model/types.h"

namespace tact::model::contact {

/// What it refers to must outlive the contact.
struct MovedContactScene {
  SmoothSurface surface;
  const law::Law* tip = nullptr;      // of the indentation alone, the same at every surface point
  const SiteLaw* coupling = nullptr;  // MC-2; none: the spheres do not feel each other
  double contact_modulus_Pa = 0.0;    // E*
  double poisson_ratio = 0.5;
  double friction_ratio = 0.0;
  double held_N_per_m = 0.0;  // tangential stiffness of a bonded disc, 1/c_side of CT-6
  double chord_ratio = kChord_ratio;
  std::span<const ProbeSphere> spheres;  // 1 to kMaxSpheres
};

/// What the last tick took.
struct MovedContactStatus {
  int steps = 0;          // of Newton, all together
  bool is_fixed = false;  // solved with its surface points where they were
  bool is_solved = true;
};

class MovedContact {
 public:
  explicit MovedContact(const MovedContactScene& scene) : scene_(scene) {}

  /// Begins at a tool outside of the organ, each sphere near a triangle.
  void start(const Tool& tool, std::span<const std::uint32_t> triangle) RT_SAFE;

  /// Once a tick, after start(). A tool that is not finite gives no force and changes nothing.
  Wrench respond(const Tool& tool) RT_SAFE;

  /// Bonds every sphere that presses, or releases all; no force changes by it.
  void hold(bool held) RT_SAFE;

  const MovedOrgan& organ() const RT_SAFE { return organ_; }
  const MovedContactStatus& status() const RT_SAFE { return status_; }

 private:
  struct Movement {
    Vec3 moved_m;              // of the centre in this tick
    double may_slide_m = 0.0;  // rest of what the surface point may move in this tick
    Vec3 brake_N;              // ML-9
  };

  void move_centres(const Tool& tool) RT_SAFE;
  void couple() RT_SAFE;
  void stiffen(OrganSphere& sphere) const RT_SAFE;
  void follow_feet() RT_SAFE;
  bool follow_foot(OrganSphere& sphere, double& may_slide_m) const RT_SAFE;
  bool solve_sliding() RT_SAFE;
  bool solve_fixed() RT_SAFE;
  void keep_last_state() RT_SAFE;
  double lost_J(double stored_before_J) const RT_SAFE;
  void brake(double lost_J) RT_SAFE;
  Wrench wrench_about(const Vec3& origin_m) const RT_SAFE;

  MovedContactScene scene_;
  MovedOrgan organ_;
  std::array<OrganSphere, kMaxSpheres> before_;  // of the last tick
  std::array<Movement, kMaxSpheres> movement_;
  double tank_J_ = 0.0;  // lost so far, at most a share of W; below 0: made
  MovedContactStatus status_;
};

}  // namespace tact::model::contact
