// SPDX-License-Identifier: Apache-2.0
// MovedContact: surface points, tangential springs and solution of ML-5 in a tick.
#include <algorithm>
#include <cmath>
#include <limits>

#include "model/contact/moved_contact.h"

namespace tact::model::contact {
namespace {

constexpr int kMaxNewtonSteps = 5;
constexpr int kMaxFixedSteps = 8;
constexpr double kSolved_m = 2e-6;  // 0.1 mN at 50 N/m
// Accepted at the step limit: the next tick continues from there. 0.6 and 3 mN at 60 N/m.
constexpr double kNearly_m = 1e-5, kNearlyFixed_m = 5e-5;
constexpr double kMaxStep_m = 5e-4;
constexpr double kMaxFixedStep_m = 2e-3;

// The part of t beyond the friction limit |t| <= mu F / k_t.
Vec3 beyond_friction(const OrganSphere& b, const Vec3& tangential_m) RT_SAFE {
  constexpr double kRounding = 1e-9;
  const double cap_m = b.friction_ratio * b.tip.force_N / b.tangential_N_per_m;
  const double t_m = norm(tangential_m);
  return t_m > cap_m * (1.0 + kRounding) ? (1.0 - cap_m / t_m) * tangential_m : Vec3{};
}

}  // namespace

// h and q of ML-8 are set at once if one of the two spheres does not press, as that changes no
// energy. If both press, they follow gradually with the tool's motion along the surface: ML-3 does
// not include their change.
void MovedContact::couple() RT_SAFE {
  constexpr double kWay_m = 0.01;
  for (std::size_t i = 0; i < organ_.count; ++i)  // bound: spheres
    for (std::size_t j = 0; j < i; ++j) {         // bound: spheres - 1; pairs in all
      const OrganSphere &a = organ_.sphere[i], &b = organ_.sphere[j];
      const ContactCoupling now = scene_.law->coupling({.surface_point = a.at.surface_point},
                                                       {.surface_point = b.at.surface_point},
                                                       norm(a.centre_m - b.centre_m));
      const bool both = (a.tip.force_N != 0.0 || a.crept_N != Vec3{}) &&
                        (b.tip.force_N != 0.0 || b.crept_N != Vec3{});
      const Vec3 way_m = 0.5 * (a.moved_m + b.moved_m);
      const double along_m = norm(tangential(way_m, normalized(a.at.normal + b.at.normal)));
      const double share = both ? std::min(along_m / kWay_m, 1.0) : 1.0;
      const double ratio = structural_ratio(organ_, i, j, now.structural_m_per_N);
      PairCompliance& pair = organ_.pair[i][j];
      pair.near_field_m_per_N += share * (now.near_field_m_per_N - pair.near_field_m_per_N);
      pair.structural_ratio += share * (ratio - pair.structural_ratio);
    }
}

// k_t = a / B of MC-5. With friction it stiffens as the contact grows and keeps its force (MC-7):
// the surface point moves nearer.
void MovedContact::stiffen(OrganSphere& b) RT_SAFE {
  constexpr double kMinGrowth = 1.01, kMinRadius_ratio = 0.1;
  if (b.is_held) return;
  const double nu = scene_.organ->poisson_ratio;
  const double b_m2_per_N = (2.0 - nu) / (4.0 * (1.0 - nu) * scene_.organ->contact_modulus_Pa);
  const double indentation_m = std::max(b.indentation_m, 0.0);
  const double a_m =
      std::clamp(std::sqrt(b.radius_m * indentation_m), kMinRadius_ratio * b.radius_m, b.radius_m);
  const double now = scene_.parameters.sliding_stiffness_N_per_m > 0.0
                         ? scene_.parameters.sliding_stiffness_N_per_m
                         : a_m / b_m2_per_N;
  const double before = b.tangential_N_per_m;
  b.friction_ratio = scene_.parameters.friction_ratio;
  if (!(indentation_m > 0.0) || before == 0.0) {
    b.tangential_N_per_m = now;
    b.rest_m = {};
    return;
  }
  if (!(b.friction_ratio > 0.0)) return;
  if (!(now > kMinGrowth * before)) return;
  is_changed_ = true;
  b.tangential_N_per_m = now;
  const SmoothSurface& surface = scene_.organ->surface;
  move_along(surface.mesh, b.at.surface_point,
             way_to_foot(b.at, b.height_m, (1.0 - before / now) * b.tangential_m));
  fill_geometry(surface, b.at);
  fill_compliance(surface, b.at);
}

// Moves a surface point as far as it slides, within may_slide_m; true if it has moved.
bool MovedContact::follow_foot(OrganSphere& b) const RT_SAFE {
  constexpr int kMaxFootSteps = 2;
  constexpr double kOnFoot_m = 2e-9;
  const bool has_friction = scene_.parameters.friction_ratio > 0.0;
  const SmoothSurface& surface = scene_.organ->surface;
  bool has_moved = false;
  b.slides = !b.is_held && b.may_slide_m > 0.0 && !(has_friction && b.tip.force_N > 0.0);
  if (b.is_held) return false;
  for (int k = 0; k < kMaxFootSteps && b.may_slide_m > 0.0; ++k) {  // bound: kMaxFootSteps
    const LocalPosition at = local_position(b.at, b.y_m);
    const Vec3 slip_m =
        has_friction ? beyond_friction(b, at.tangential_m - b.rest_m) : at.tangential_m - b.rest_m;
    // Slip from ticks in which the surface point could not move (rest_m) is made up for now.
    Vec3 way_m = way_to_foot(b.at, at.height_m, slip_m == Vec3{} ? slip_m : slip_m + b.rest_m);
    const double length_m = norm(way_m);
    if (!(length_m >= kOnFoot_m)) break;
    const double share = std::min(1.0, b.may_slide_m / length_m);
    way_m *= share;
    b.rest_m *= 1.0 - share;
    b.may_slide_m -= std::min(length_m, b.may_slide_m);
    move_along(surface.mesh, b.at.surface_point, way_m);
    fill_geometry(surface, b.at);
    has_moved = true;
    b.slides = b.may_slide_m > 0.0;
  }
  if (has_moved) fill_compliance(surface, b.at);
  // The surface point may not move farther, but the force must stay in the friction cone.
  if (!(b.may_slide_m > 0.0)) {
    const Vec3 t_m = local_position(b.at, b.y_m).tangential_m - b.rest_m;
    const Vec3 slip_m = has_friction ? beyond_friction(b, t_m) : t_m;
    const double length_m = norm(slip_m), now_m = std::min(length_m, b.may_slip_m);
    if (now_m > 0.0) b.rest_m += (now_m / length_m) * slip_m;
    b.may_slip_m -= now_m;
  }
  return has_moved;
}

void MovedContact::follow_feet() RT_SAFE {
  bool has_moved = false;
  for (std::size_t i = 0; i < organ_.count; ++i)  // bound: spheres
    if (follow_foot(organ_.sphere[i])) has_moved = true;
  if (has_moved) fill_matrices(organ_);
}

// If only the centres moved, the residual is the last one plus their displacement: no evaluate() is
// needed before the first step. The slope of an earlier tick is kept while it converges fast.
bool MovedContact::solve_sliding() RT_SAFE {
  is_nearly_ = false;
  constexpr double kFast_ratio = 0.4;  // residual after a step over that before
  double before_m = 0.0;
  for (std::size_t i = 0; i < organ_.count; ++i) {  // bound: spheres
    OrganSphere& b = organ_.sphere[i];
    b.residual_m += b.moved_m;
    const double residual_m = norm(b.residual_m);
    if (!(residual_m <= before_m)) before_m = residual_m;  // NaN is not small
  }
  if (!is_changed_ && before_m < kSolved_m) return true;
  if (is_changed_) {
    follow_feet();
    before_m = evaluate(organ_);
    if (before_m < kSolved_m) return true;
    organ_.has_slope = false;
  }
  for (int i = 0; i < kMaxNewtonSteps; ++i, ++status_.steps) {  // bound: kMaxNewtonSteps
    if (!organ_.has_slope && !find_slope(organ_)) return false;
    if (!newton_step(organ_, kMaxStep_m, 1.0)) return false;
    follow_feet();
    const double now_m = evaluate(organ_);
    organ_.has_slope = now_m < std::max(kFast_ratio * before_m, kSolved_m);
    if (now_m < kSolved_m) {
      ++status_.steps;
      return true;
    }
    before_m = now_m;
  }
  is_nearly_ = before_m < kNearly_m;
  return is_nearly_;
}

bool MovedContact::solve_fixed() RT_SAFE {
  constexpr double kMaxResidual_ratio = 0.95;
  status_.is_fixed = true;
  organ_.has_slope = false;
  for (std::size_t i = 0; i < organ_.count; ++i) organ_.sphere[i].slides = false;  // bound: spheres
  double before_m = std::numeric_limits<double>::infinity(), share = 1.0;
  for (int i = 0; i <= kMaxFixedSteps; ++i) {  // bound: kMaxFixedSteps + 1 (evaluations)
    const double residual_m = evaluate(organ_);
    if (residual_m < kSolved_m) return true;
    // Without damping a sphere could alternate for ever between contact and no contact.
    share = residual_m < kMaxResidual_ratio * before_m ? std::min(2.0 * share, 1.0) : 0.5 * share;
    before_m = residual_m;
    if (i == kMaxFixedSteps || !find_slope(organ_) || !newton_step(organ_, kMaxFixedStep_m, share))
      break;
    ++status_.steps;
  }
  return before_m < kNearlyFixed_m;
}

// ML-9   brake_i = -rho |P_i| dc_i / |dc_i|,   rho = excess / sum |P_i| |dc_i|
// Lost energy: work of the spheres in this tick, by the trapezium rule, minus the change of W.
void MovedContact::brake() RT_SAFE {
  constexpr double kFree_J = 2e-7;                               // permitted per contact
  constexpr double kTank_ratio = 0.05, kTolerated_ratio = 0.02;  // of W
  constexpr double kMaxBrake_ratio = 0.1;                        // of |P|
  constexpr double kMaxChange_N = 5e-4;                          // a tick
  double braked_J = 0.0, way_J = 0.0, press_N = 0.0, work_J = 0.0;
  for (std::size_t i = 0; i < organ_.count; ++i) {  // bound: spheres
    const OrganSphere& b = organ_.sphere[i];
    const double force_N = norm(b.force_N);
    braked_J -= dot(b.brake_N, b.moved_m);
    way_J += force_N * norm(b.moved_m);
    work_J -= 0.5 * dot(b.force_N + before_[i].force_N, b.moved_m);
    press_N += force_N;
  }
  const double stored_J = stored_energy_J(organ_), lost_J = work_J - (stored_J - stored_J_);
  stored_J_ = stored_J;
  tank_J_ = std::min(tank_J_ + lost_J + braked_J, kTank_ratio * stored_J);
  if (!(press_N > 0.0)) tank_J_ = 0.0;  // the next contact begins at zero
  const double excess_J = std::max(-(tank_J_ + kFree_J + kTolerated_ratio * stored_J), 0.0);
  const double rho = way_J > 0.0 ? std::min(excess_J / way_J, kMaxBrake_ratio) : 0.0;
  for (std::size_t i = 0; i < organ_.count; ++i) {  // bound: spheres
    OrganSphere& b = organ_.sphere[i];
    const Vec3 wanted_N = -rho * norm(b.force_N) * normalized(b.moved_m);
    const Vec3 change_N = wanted_N - b.brake_N;
    const double length_N = norm(change_N);
    b.brake_N += (length_N > kMaxChange_N ? kMaxChange_N / length_N : 1.0) * change_N;
    // It changes slowly, never acts along the motion, and is at most kMaxBrake_ratio of the force.
    const Vec3 along = normalized(b.moved_m);
    b.brake_N -= std::max(dot(b.brake_N, along), 0.0) * along;
    const double brake_N = norm(b.brake_N), most_N = kMaxBrake_ratio * norm(b.force_N);
    if (brake_N > most_N) b.brake_N *= most_N / brake_N;
  }
}

}  // namespace tact::model::contact
