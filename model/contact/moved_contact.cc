// SPDX-License-Identifier: Apache-2.0
#include "model/contact/moved_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tact::model::contact {
namespace {

constexpr int kMaxNewtonSteps = 8;
constexpr int kMaxFixedSteps = 8;
constexpr double kSolved_m = 1e-6;  // 0.05 mN at 50 N/m
constexpr double kNearly_m = 5e-5;  // enough where the steps end
constexpr double kMaxStep_m = 5e-4;
constexpr double kMaxFixedStep_m = 2e-3;

// How far a surface point may move in a tick, by the way of its sphere.
constexpr double kFollow_ratio = 3.0;
constexpr double kCreep_m = 2e-6;
// Near a centre of curvature the foot moves without bound: the surface point slows, then sticks.
constexpr double kStuckOffset_ratio = 0.1, kFreeOffset_ratio = 0.4;

// A surface point at the foot of a centre outside of the organ, by steps of at most 2 mm.
void find_foot(const SmoothSurface& surface, OrganSphere& b) RT_SAFE {
  constexpr int kMaxWalk = 100;
  constexpr double kMaxWay_m = 2e-3, kOnFoot_m = 1e-9;
  for (int i = 0; i < kMaxWalk; ++i) {
    fill_geometry(surface, b.at);
    const LocalPosition at = local_position(b.at, b.y_m);
    Vec3 way_m = way_to_foot(b.at, at.height_m, at.tangential_m);
    const double length_m = norm(way_m);
    if (!(length_m >= kOnFoot_m)) break;
    if (length_m > kMaxWay_m) way_m *= kMaxWay_m / length_m;
    move_along(surface.mesh, b.at.place, way_m);
  }
  fill_compliance(surface, b.at);
}

// What of w friction does not hold: |w| <= mu F / k_w.
Vec3 beyond_friction(const OrganSphere& b, const Vec3& tangential_m) RT_SAFE {
  constexpr double kRounding = 1e-9;
  const double cap_m = b.friction_ratio * b.tip.force_N / b.tangential_N_per_m;
  const double w_m = norm(tangential_m);
  return w_m > cap_m * (1.0 + kRounding) ? (1.0 - cap_m / w_m) * tangential_m : Vec3{};
}

}  // namespace

void MovedContact::start(const Tool& tool, std::span<const std::uint32_t> triangle) RT_SAFE {
  organ_ = {};
  movement_ = {};
  tank_J_ = 0.0;
  organ_.tip = scene_.tip;
  organ_.contact_modulus_Pa = scene_.contact_modulus_Pa;
  organ_.chord_ratio = scene_.chord_ratio;
  organ_.count = scene_.spheres.size();
  for (std::size_t i = 0; i < organ_.count; ++i) {
    OrganSphere& b = organ_.sphere[i];
    b.radius_m = scene_.spheres[i].radius_m;
    b.height_m = b.radius_m;
    b.centre_m = b.y_m = tool.position_m + rotate(tool.orientation, scene_.spheres[i].offset_m);
    b.at.place = {.triangle = triangle[i], .weight = {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}};
    find_foot(scene_.surface, b);
  }
  couple();
  fill_matrices(organ_);
}

void MovedContact::move_centres(const Tool& tool) RT_SAFE {
  for (std::size_t i = 0; i < organ_.count; ++i) {
    OrganSphere& b = organ_.sphere[i];
    const Vec3 centre_m = tool.position_m + rotate(tool.orientation, scene_.spheres[i].offset_m);
    const double share = std::clamp((offset_ratio(b.at, b.height_m) - kStuckOffset_ratio) /
                                        (kFreeOffset_ratio - kStuckOffset_ratio),
                                    0.0, 1.0);
    Movement& movement = movement_[i];
    movement.moved_m = centre_m - b.centre_m;
    movement.may_slide_m = share * (kFollow_ratio * norm(movement.moved_m) + kCreep_m);
    b.centre_m = centre_m;
  }
}

// ML-8's h and q are set where one of the two does not press, as that moves no energy. Where both
// do, they follow the surface points over a way of the tool along the surface: ML-3 knows nothing
// of how they change.
void MovedContact::couple() RT_SAFE {
  constexpr double kWay_m = 0.01;
  if (scene_.coupling == nullptr) return;
  for (std::size_t i = 0; i < organ_.count; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const OrganSphere &a = organ_.sphere[i], &b = organ_.sphere[j];
      const SiteCoupling now = scene_.coupling->coupling(
          {.place = a.at.place}, {.place = b.at.place}, norm(a.centre_m - b.centre_m));
      const bool both = a.tip.force_N != 0.0 && b.tip.force_N != 0.0;
      const Vec3 way_m = 0.5 * (movement_[i].moved_m + movement_[j].moved_m);
      const double along_m = norm(tangential(way_m, normalized(a.at.normal + b.at.normal)));
      const double share = both ? std::min(along_m / kWay_m, 1.0) : 1.0;
      const double ratio = structural_ratio(organ_, i, j, now.lobe_m_per_N);
      PairCompliance& pair = organ_.pair[i][j];
      pair.near_field_m_per_N += share * (now.skin_m_per_N - pair.near_field_m_per_N);
      pair.structural_ratio += share * (ratio - pair.structural_ratio);
    }
}

// k_w = a / c of MC-5. With friction it stiffens as the contact grows and keeps its force, as MC-7
// has it: the surface point comes nearer.
void MovedContact::stiffen(OrganSphere& b) const RT_SAFE {
  constexpr double kMinGrowth = 1.01, kMinRadius_ratio = 0.1;
  if (b.is_held) return;
  const double nu = scene_.poisson_ratio;
  const double c = (2.0 - nu) / (4.0 * (1.0 - nu) * scene_.contact_modulus_Pa);
  const double indentation_m = std::max(b.radius_m - b.height_m, 0.0);
  const double a_m =
      std::clamp(std::sqrt(b.radius_m * indentation_m), kMinRadius_ratio * b.radius_m, b.radius_m);
  const double now = a_m / c, before = b.tangential_N_per_m;
  b.friction_ratio = scene_.friction_ratio;
  if (!(indentation_m > 0.0) || before == 0.0 || !(b.friction_ratio > 0.0)) {
    b.tangential_N_per_m = now;
    b.rest_m = {};
    return;
  }
  if (!(now > kMinGrowth * before)) return;
  b.tangential_N_per_m = now;
  move_along(scene_.surface.mesh, b.at.place,
             way_to_foot(b.at, b.height_m, (1.0 - before / now) * b.tangential_m));
  fill_geometry(scene_.surface, b.at);
  fill_compliance(scene_.surface, b.at);
}

// The spring of a sphere that is let go stays as it is until it slips or the sphere leaves.
void MovedContact::hold(bool held) RT_SAFE {
  for (std::size_t i = 0; i < organ_.count; ++i) {
    OrganSphere& b = organ_.sphere[i];
    if (held && !(b.tip.force_N > 0.0)) continue;
    b.is_held = held;
    if (!held) continue;
    b.rest_m += (1.0 - b.tangential_N_per_m / scene_.held_N_per_m) * b.tangential_m;
    b.tangential_N_per_m = scene_.held_N_per_m;
  }
}

// Moves a surface point as far as it slides, within its budget; returns whether it has moved.
bool MovedContact::follow_foot(OrganSphere& b, double& may_slide_m) const RT_SAFE {
  constexpr int kMaxFootSteps = 2;
  constexpr double kOnFoot_m = 2e-9;
  const bool has_friction = scene_.friction_ratio > 0.0;
  bool has_moved = false;
  b.slides = !b.is_held && may_slide_m > 0.0 && !(has_friction && b.tip.force_N > 0.0);
  if (b.is_held) return false;
  for (int k = 0; k < kMaxFootSteps && may_slide_m > 0.0; ++k) {
    const LocalPosition at = local_position(b.at, b.y_m);
    const Vec3 w_m = at.tangential_m - b.rest_m;
    Vec3 way_m = way_to_foot(b.at, at.height_m, has_friction ? beyond_friction(b, w_m) : w_m);
    const double length_m = norm(way_m);
    if (!(length_m >= kOnFoot_m)) break;
    if (length_m > may_slide_m) way_m *= may_slide_m / length_m;
    may_slide_m -= std::min(length_m, may_slide_m);
    move_along(scene_.surface.mesh, b.at.place, way_m);
    fill_geometry(scene_.surface, b.at);
    has_moved = true;
    b.slides = may_slide_m > 0.0;
  }
  if (has_moved) fill_compliance(scene_.surface, b.at);
  return has_moved;
}

void MovedContact::follow_feet() RT_SAFE {
  bool has_moved = false;
  for (std::size_t i = 0; i < organ_.count; ++i)
    if (follow_foot(organ_.sphere[i], movement_[i].may_slide_m)) has_moved = true;
  if (has_moved) fill_matrices(organ_);
}

bool MovedContact::solve_sliding() RT_SAFE {
  for (int i = 0; i <= kMaxNewtonSteps; ++i) {
    follow_feet();
    if (evaluate(organ_) < kSolved_m) return true;
    if (i == kMaxNewtonSteps || !newton_step(organ_, kMaxStep_m, 1.0)) break;
    ++status_.steps;
  }
  return false;
}

bool MovedContact::solve_fixed() RT_SAFE {
  constexpr double kProgress = 0.7;
  status_.is_fixed = true;
  for (std::size_t i = 0; i < organ_.count; ++i) organ_.sphere[i].slides = false;
  double before_m = std::numeric_limits<double>::infinity(), share = 1.0;
  for (int i = 0; i <= kMaxFixedSteps; ++i) {
    const double residual_m = evaluate(organ_);
    if (residual_m < kSolved_m) return true;
    // A sphere that touches after one step and not after the next would alternate for ever.
    share = residual_m < kProgress * before_m ? std::min(2.0 * share, 1.0) : 0.5 * share;
    before_m = residual_m;
    if (i == kMaxFixedSteps || !newton_step(organ_, kMaxFixedStep_m, share)) break;
    ++status_.steps;
  }
  return before_m < kNearly_m;
}

// Neither way has an answer: everything as before, but for the force along the movement.
void MovedContact::keep_last_state() RT_SAFE {
  for (std::size_t i = 0; i < organ_.count; ++i) {
    OrganSphere& b = organ_.sphere[i];
    const Vec3 centre_m = b.centre_m;
    b = before_[i];
    b.centre_m = centre_m;
    const Vec3 along = normalized(movement_[i].moved_m);
    b.force_N -= std::max(dot(b.force_N, along), 0.0) * along;
  }
}

// Work of the spheres in this tick, by the trapezium rule, less what W has gained.
double MovedContact::lost_J(double stored_before_J) const RT_SAFE {
  double work_J = 0.0;
  for (std::size_t i = 0; i < organ_.count; ++i)
    work_J -= 0.5 * dot(organ_.sphere[i].force_N + before_[i].force_N, movement_[i].moved_m);
  return work_J - (stored_energy_J(organ_) - stored_before_J);
}

// ML-9   brake_i = -rho F_i dc_i / |dc_i|,   rho = excess / sum F_i |dc_i|
void MovedContact::brake(double lost_J) RT_SAFE {
  constexpr double kFree_J = 2e-7;                               // of one contact, in all
  constexpr double kTank_ratio = 0.05, kTolerated_ratio = 0.02;  // of W
  constexpr double kMaxBrake_ratio = 0.1;                        // of F
  constexpr double kMaxChange_N = 5e-4;                          // a tick
  double braked_J = 0.0, way_J = 0.0, press_N = 0.0;
  for (std::size_t i = 0; i < organ_.count; ++i) {
    const double force_N = norm(organ_.sphere[i].force_N);
    braked_J -= dot(movement_[i].brake_N, movement_[i].moved_m);
    way_J += force_N * norm(movement_[i].moved_m);
    press_N += force_N;
  }
  const double stored_J = stored_energy_J(organ_);
  tank_J_ = std::min(tank_J_ + lost_J + braked_J, kTank_ratio * stored_J);
  if (!(press_N > 0.0)) tank_J_ = 0.0;  // the next contact begins at zero
  const double excess_J = std::max(-(tank_J_ + kFree_J + kTolerated_ratio * stored_J), 0.0);
  const double rho = way_J > 0.0 ? std::min(excess_J / way_J, kMaxBrake_ratio) : 0.0;
  for (std::size_t i = 0; i < organ_.count; ++i) {
    Movement& m = movement_[i];
    const Vec3 wanted_N = -rho * norm(organ_.sphere[i].force_N) * normalized(m.moved_m);
    const Vec3 change_N = wanted_N - m.brake_N;
    const double length_N = norm(change_N);
    m.brake_N += (length_N > kMaxChange_N ? kMaxChange_N / length_N : 1.0) * change_N;
  }
}

Wrench MovedContact::respond(const Tool& tool) RT_SAFE {
  if (!is_finite(tool)) return {};
  status_ = {};
  const double stored_before_J = stored_energy_J(organ_);
  before_ = organ_.sphere;
  move_centres(tool);
  couple();
  for (std::size_t i = 0; i < organ_.count; ++i) stiffen(organ_.sphere[i]);
  fill_matrices(organ_);
  status_.is_solved = solve_sliding() || solve_fixed();
  if (!status_.is_solved) keep_last_state();
  brake(lost_J(stored_before_J));
  return wrench_about(tool.position_m);
}

Wrench MovedContact::wrench_about(const Vec3& origin_m) const RT_SAFE {
  Wrench out;
  for (std::size_t i = 0; i < organ_.count; ++i) {
    const OrganSphere& b = organ_.sphere[i];
    const Vec3 force_N = b.force_N + movement_[i].brake_N;
    out.force_N += force_N;
    out.torque_Nm += cross(b.centre_m - origin_m, force_N);
  }
  return out;
}

}  // namespace tact::model::contact
