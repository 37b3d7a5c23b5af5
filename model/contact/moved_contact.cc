// SPDX-License-Identifier: Apache-2.0
#include "model/contact/moved_contact.h"

#include <algorithm>
#include <cmath>

namespace tact::model::contact {
namespace {

// Largest motion of a surface point in a tick over the displacement of its sphere, plus kCreep_m.
constexpr double kFollow_ratio = 3.0;
constexpr double kCreep_m = 2e-6;
// Near a centre of curvature the foot point moves without bound: the surface point slows, stops.
constexpr double kStuckOffset_ratio = 0.1, kFreeOffset_ratio = 0.4;

// Moves the surface point to the foot point of y, in steps of at most 2 mm.
void find_foot(const SmoothSurface& surface, OrganSphere& b) RT_SAFE {
  constexpr int kMaxWalk = 100;
  constexpr double kMaxWay_m = 2e-3, kOnFoot_m = 1e-9;
  for (int i = 0; i < kMaxWalk; ++i) {  // bound: kMaxWalk
    fill_geometry(surface, b.at);
    const LocalPosition at = local_position(b.at, b.y_m);
    Vec3 way_m = way_to_foot(b.at, at.height_m, at.tangential_m);
    const double length_m = norm(way_m);
    if (!(length_m >= kOnFoot_m)) break;
    if (length_m > kMaxWay_m) way_m *= kMaxWay_m / length_m;
    move_along(surface.mesh, b.at.surface_point, way_m);
  }
  fill_compliance(surface, b.at);
}

}  // namespace

MovedContact::MovedContact(const ContactScene& scene) : scene_(scene) { reset(); }

void MovedContact::reset() RT_SAFE {
  organ_ = {};
  tank_J_ = stored_J_ = 0.0;
  is_changed_ = true;
  status_ = {};
  if (scene_.organ == nullptr) return;
  organ_.law = scene_.law;
  organ_.contact_modulus_Pa = scene_.organ->contact_modulus_Pa;
  organ_.chord_ratio = scene_.organ->chord_ratio;
  organ_.creep = scene_.organ->creep;
}

OrganSphere* MovedContact::at(std::size_t sphere) RT_SAFE {  // bound: spheres (as find())
  for (std::size_t i = 0; i < organ_.count; ++i)             // bound: spheres
    if (organ_.sphere[i].index == sphere) return &organ_.sphere[i];
  return nullptr;
}
const OrganSphere* MovedContact::find(std::size_t sphere) const RT_SAFE {
  for (std::size_t i = 0; i < organ_.count; ++i)  // bound: spheres
    if (organ_.sphere[i].index == sphere) return &organ_.sphere[i];
  return nullptr;
}

// Starts a contact on the organ as displaced by the other spheres.
void MovedContact::begin(const Sphere& sphere, const ContactPoint& contact_point,
                         double explained_m) RT_SAFE {
  OrganSphere& b = organ_.sphere[organ_.count++];
  b = {};
  is_changed_ = true;
  organ_.has_slope = false;
  b.index = sphere.index;
  b.radius_m = b.height_m = sphere.radius_m;
  b.centre_m = b.y_m = sphere.centre_m;
  b.at.surface_point = {.triangle = contact_point.surface_point.triangle,
                        .weight = {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}};
  find_foot(scene_.organ->surface, b);
  couple();
  fill_matrices(organ_);
  const std::size_t i = organ_.count - 1;
  for (std::size_t j = 0; j < i; ++j)  // bound: spheres - 1 (others)
    b.shift_m +=
        organ_.compliance_m_per_N[i][j] * (organ_.sphere[j].organ_N + organ_.sphere[j].crept_N);
  b.y_m = sphere.centre_m - b.shift_m;
  find_foot(scene_.organ->surface, b);
  couple();
  fill_matrices(organ_);
  b.height_m = local_position(b.at, b.y_m).height_m;
  b.depth_offset_m = std::max(0.0, b.radius_m - b.height_m - explained_m);
}

void MovedContact::leave(std::size_t sphere) RT_SAFE {
  const OrganSphere* gone = find(sphere);
  if (gone == nullptr) return;
  const auto slot = static_cast<std::size_t>(gone - organ_.sphere.data());
  // Without its creep the organ moves towards the other spheres: that depth is offset.
  for (std::size_t i = 0; i < organ_.count; ++i) {  // bound: spheres
    OrganSphere& b = organ_.sphere[i];
    const Vec3 lifted_m = organ_.compliance_m_per_N[i][slot] * gone->crept_N;
    if (i != slot && !b.is_held) b.depth_offset_m += std::max(0.0, -dot(b.at.normal, lifted_m));
  }
  // bound: spheres - 1 (others)
  for (std::size_t i = slot; i + 1 < organ_.count; ++i) organ_.sphere[i] = organ_.sphere[i + 1];
  // pair[i][j] with j < i: removes row and column of the sphere that has left.
  const auto old = [slot](std::size_t i) RT_SAFE { return i < slot ? i : i + 1; };
  --organ_.count;
  if (organ_.count == 0) tank_J_ = stored_J_ = 0.0;  // the next contact begins at zero
  is_changed_ = true;
  organ_.has_slope = false;
  for (std::size_t i = 0; i < organ_.count; ++i)  // bound: spheres
    // bound: spheres - 1; pairs in all
    for (std::size_t j = 0; j < i; ++j) organ_.pair[i][j] = organ_.pair[old(i)][old(j)];
  fill_matrices(organ_);
}

void MovedContact::move(const Sphere& sphere) RT_SAFE {
  OrganSphere* b = at(sphere.index);
  if (b == nullptr) return;
  const double share = std::clamp((offset_ratio(b->at, b->height_m) - kStuckOffset_ratio) /
                                      (kFreeOffset_ratio - kStuckOffset_ratio),
                                  0.0, 1.0);
  const double most_m = std::max(b->radius_m - b->height_m, 0.0);
  if (!b->is_held && b->depth_offset_m > most_m) {
    b->depth_offset_m = most_m;
    is_changed_ = true;
  }
  b->moved_m = sphere.centre_m - b->centre_m;
  b->may_slip_m = kFollow_ratio * norm(b->moved_m) + kCreep_m;
  b->may_slide_m = share * b->may_slip_m;
  b->centre_m = sphere.centre_m;
  b->speed_mps = -dot(sphere.velocity_mps, b->at.normal);
}

void MovedContact::add_depth_offset(std::size_t sphere, double depth_m) RT_SAFE {
  OrganSphere* b = at(sphere);
  if (b == nullptr || !(depth_m > 0.0)) return;
  b->depth_offset_m += depth_m;
  is_changed_ = true;
}

bool MovedContact::hold(std::size_t sphere) RT_SAFE {
  OrganSphere* b = at(sphere);
  if (b == nullptr || !(b->tip.force_N > 0.0)) return false;
  // Never softer: a softer spring would store more energy at the same force.
  const double before = b->tangential_N_per_m, now = std::max(scene_.organ->held_N_per_m, before);
  b->is_held = true;
  is_changed_ = true;
  b->rest_m += (1.0 - before / now) * b->tangential_m;
  b->tangential_m *= before / now;
  b->tangential_N_per_m = now;
  return true;
}

double MovedContact::pull_N(std::size_t sphere) const RT_SAFE {
  const OrganSphere& b = *find(sphere);
  return std::hypot(std::max(0.0, -b.tip.force_N), b.tangential_N_per_m * norm(b.tangential_m));
}

// W(d) <= W_held, d no larger than it was held
// The sphere returns to the nearest surface point without a tangential spring. While that stores
// more energy than before, the depth is halved by an offset.
bool MovedContact::release(std::size_t sphere) RT_SAFE {
  constexpr int kHalvings = 12;  // each solves for all spheres
  OrganSphere* b = at(sphere);
  if (b == nullptr) return false;
  const double held_J = stored_energy_J(organ_);
  const double held_m = std::max(b->indentation_m, 0.0);
  b->is_held = false;
  is_changed_ = true;
  b->rest_m = {};
  b->tangential_N_per_m = 0.0;
  find_foot(scene_.organ->surface, *b);
  fill_matrices(organ_);
  const double deepest_m = b->radius_m - local_position(b->at, b->y_m).height_m;
  double share = 1.0;
  // bound: kHalvings + 1 (and none)
  for (int i = 0; i <= kHalvings; ++i, share = i < kHalvings ? 0.5 * share : 0.0) {
    // Solving changes y: additional indentation is offset, too.
    b->depth_offset_m = std::max(deepest_m - share * held_m, 0.0);
    status_.is_solved = solve_fixed();
    b->depth_offset_m += std::max(b->indentation_m - share * held_m, 0.0);
    status_.is_solved = solve_fixed() && status_.is_solved;
    if (status_.is_solved && stored_energy_J(organ_) <= held_J) break;
  }
  return true;
}

// Without a solution: the last state, and the last force without its part along the motion.
void MovedContact::keep_last_state() RT_SAFE {
  for (std::size_t i = 0; i < organ_.count; ++i) {  // bound: spheres
    OrganSphere& b = organ_.sphere[i];
    const Vec3 centre_m = b.centre_m, moved_m = b.moved_m;
    b = before_[i];
    b.centre_m = centre_m, b.moved_m = moved_m;
    const Vec3 along = normalized(moved_m);
    b.force_N -= std::max(dot(b.force_N, along), 0.0) * along;
    // Resets the state of a law to the kept depth, after depths that were only tried.
    if (b.indentation_m > 0.0 || b.is_held) scene_.law->respond(indentation_of(b));
  }
}

void MovedContact::respond() RT_SAFE {
  status_ = {};
  if (organ_.count == 0) return;
  std::copy_n(organ_.sphere.begin(), organ_.count, before_.begin());  // bound: spheres
  couple();
  for (std::size_t i = 0; i < organ_.count; ++i) stiffen(organ_.sphere[i]);  // bound: spheres
  fill_matrices(organ_);
  status_.is_solved = solve_sliding() || solve_fixed();
  is_changed_ = !status_.is_solved || is_nearly_ || organ_.creep.terms() > 0;
  if (!status_.is_solved) keep_last_state();
  brake();
}

OrganForce MovedContact::report(const Sphere& sphere, SphereContact& reported) const RT_SAFE {
  const OrganSphere& b = *find(sphere.index);
  reported.surface_point = b.at.surface_point;
  reported.surface_point_m = b.at.point_m;
  reported.normal = b.at.normal;
  reported.indentation_m = b.indentation_m;
  reported.depth_offset_m = b.depth_offset_m;
  reported.depth_m = b.indentation_m - dot(b.shift_m, b.at.normal);
  reported.shift_m = tangential(b.shift_m, b.at.normal);
  reported.law_status = is_beyond(b) ? law::LawStatus::kSaturated : b.tip.status;
  reported.energy_J = stored_energy_J(organ_, static_cast<std::size_t>(&b - organ_.sphere.data()));
  const double resistance_N = scene_.law->resistance_N(indentation_of(b), b.tip.force_N);
  return {b.force_N,
          b.brake_N + resistance_N * rotated(b.rotation.whole, b.rotation.axis, b.at.normal)};
}

void MovedContact::advance() RT_SAFE {
  if (organ_.creep.terms() == 0) return;
  for (std::size_t i = 0; i < organ_.count; ++i) {  // bound: spheres
    OrganSphere& b = organ_.sphere[i];
    organ_.creep.advance(b.creep, b.organ_N);
    b.crept_N = organ_.creep.crept_N(b.creep);
  }
}

}  // namespace tact::model::contact
