// SPDX-License-Identifier: Apache-2.0
// Contact with an organ that bends far: when a sphere that touches it lets go, holds, tears and
// leaves. The forces are those of moved_contact.h.
#include <algorithm>
#include <cmath>
#include <limits>

#include "model/contact/contact.h"

namespace tact::model::contact {
namespace {

constexpr double kUnknown_m = -kAnywhere_m;

}  // namespace

void Contact::begin_moved(std::size_t i, const Site& site, double paid_m) RT_SAFE {
  probe_[i].clear_m = kUnknown_m;
  probe_[i].deep_m = kUnknown_m;
  moved_.begin(i, probe_[i].centre_m, site.place.triangle, paid_m);
}

// A sphere that presses stays. One without force is searched for again: it may be in the dent of
// another sphere, at another part of the organ, or outside.
void Contact::step_moved(std::size_t i, const Vec3& moved_m) RT_SAFE {
  Probe& probe = probe_[i];
  const OrganSphere& sphere = *moved_.find(i);
  if (probe.unsolved_ratio >= 1.0) {
    leave(i, TouchState::kFree);
    return find(i);
  }
  if (touch_[i].state == TouchState::kHeld || sphere.indentation_m > 0.0) {
    if (!probe.is_pressing) probe.clear_m = kUnknown_m;  // from now on of the organ at rest
    probe.is_pressing = true;
    return;
  }
  if (probe.is_pressing) probe.clear_m = kUnknown_m;
  probe.is_pressing = false;
  // The organ moves under it, too.
  probe.clear_m -= norm(sphere.shift_m - probe.organ_shift_m);
  probe.organ_shift_m = sphere.shift_m;
  if (probe.clear_m > 0.0 && !probe.lets_go) return;
  const double radius_m = scene_.spheres[i].radius_m;
  const double within_m = (1.0 + kAhead_ratio) * radius_m;
  const Vec3 y_m = sphere.y_m + (probe.centre_m - sphere.centre_m);
  const Site on_organ =
      nearest_site(scene_.tree, scene_.surface, y_m, within_m, sphere.at.place.triangle);
  probe.clear_m = std::min(on_organ.distance_m, within_m) - radius_m;
  const bool is_elsewhere = norm(on_organ.point_m - sphere.at.point_m) > radius_m;
  if (probe.clear_m > 0.0 ? !is_free_at_rest(i) && !probe.lets_go : !is_elsewhere && !probe.lets_go)
    return;
  leave(i, TouchState::kFree);
  begin_from_outside(i, moved_m);
}

// Of the organ at rest, which does not move under a sphere that is alone.
bool Contact::is_free_at_rest(std::size_t i) RT_SAFE {
  const Site site = nearest_site(scene_.tree, scene_.surface, probe_[i].centre_m,
                                 scene_.spheres[i].radius_m, probe_[i].near);
  return !(site.distance_m < scene_.spheres[i].radius_m);
}

bool Contact::is_beyond_moved(const OrganSphere& b) const RT_SAFE {
  return b.tip.status == law::LawStatus::kSaturated || norm(b.shift_m) > scene_.organ->range_m;
}

// Outside of the organ at rest and beyond its law; or outside of the organ as it is moved, with
// nothing of it between the sphere and its place.
bool Contact::must_let_go_moved(std::size_t i, const OrganSphere& b) RT_SAFE {
  if (is_beyond_moved(b) && is_outside(i)) return true;
  // Over its place.
  if (b.height_m > -b.radius_m && norm(b.tangential_m) < b.radius_m) return false;
  Probe& probe = probe_[i];
  probe.deep_m -= norm(b.y_m - probe.y_m);
  probe.y_m = b.y_m;
  if (probe.deep_m > 0.0) return false;
  const Site site =
      nearest_site(scene_.tree, scene_.surface, b.y_m, kAnywhere_m, b.at.place.triangle);
  probe.deep_m = b.radius_m - site.distance_m;
  if (probe.deep_m > 0.0) return false;
  constexpr double kOffSurface_ratio = 1e-3;  // of the way: the place itself is on the surface
  return !is_between(scene_.tree, scene_.surface,
                     b.at.point_m + kOffSurface_ratio * (b.y_m - b.at.point_m), b.y_m);
}

// Its depth and the organ's shift shrink to 0 together.
void Contact::let_go_moved(std::size_t i) RT_SAFE {
  const OrganSphere& b = *moved_.find(i);
  Probe& probe = probe_[i];
  if (touch_[i].state != TouchState::kTouching || !(b.indentation_m > 0.0)) return;
  if (!probe.lets_go) {
    probe.lets_go = must_let_go_moved(i, b);
    probe.within_law_m = std::min(b.indentation_m, scene_.organ->range_m) + norm(b.shift_m);
    if (!probe.lets_go) return;
    moved_.add_slack(i, std::max(0.0, b.indentation_m - scene_.organ->range_m));
  }
  moved_.add_slack(
      i, kSlide_ratio * norm(probe.moved_m) + probe.within_law_m * scene_.period_s / kLetGo_s);
}

// The first that must: its going changes what the others feel.
bool Contact::release_moved() RT_SAFE {
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i) {
    if (touch_[i].state != TouchState::kHeld) continue;
    const OrganSphere& b = *moved_.find(i);
    const double pull_N =
        std::hypot(std::max(0.0, -b.tip.force_N), b.tangential_N_per_m * norm(b.tangential_m));
    // What is no number tears: it must not hold the tool.
    if (closed_ && pull_N <= scene_.parameters.tear_force_N) continue;
    touch_[i].state = TouchState::kTouching;
    moved_.release(i);
    return true;
  }
  return false;
}

void Contact::hold_moved() RT_SAFE {
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i) {
    if (touch_[i].state != TouchState::kTouching || !(moved_.find(i)->tip.force_N > 0.0)) continue;
    moved_.hold(i);
    touch_[i].state = TouchState::kHeld;
  }
}

void Contact::respond_moved() RT_SAFE {
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i)
    if (in_contact(i)) let_go_moved(i);
  moved_.respond();
  for (std::size_t i = 0; i < scene_.spheres.size() && release_moved(); ++i) {
  }
  if (closing_) hold_moved();
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i) {
    if (in_contact(i)) {
      fade_unsolved(i);
      sum_up_moved(i);
    } else {
      tell_force(i, {});
    }
  }
  moved_.advance();
}

// A place without an answer keeps its last force, and loses it in 0.1 s or one radius of way.
void Contact::fade_unsolved(std::size_t i) RT_SAFE {
  Probe& probe = probe_[i];
  if (moved_.status().is_solved) {
    probe.unsolved_ratio = 0.0;
    return;
  }
  probe.unsolved_ratio +=
      scene_.period_s / kLetGo_s + norm(probe.moved_m) / scene_.spheres[i].radius_m;
}

void Contact::sum_up_moved(std::size_t i) RT_SAFE {
  const OrganSphere& b = *moved_.find(i);
  SphereTouch& touch = touch_[i];
  touch.place = b.at.place;
  touch.surface_point_m = b.at.point_m;
  touch.normal = b.at.normal;
  touch.dent_m = b.indentation_m;
  touch.slack_m = b.slack_m;
  touch.depth_m = b.indentation_m - dot(b.shift_m, b.at.normal);
  touch.shift_m = tangential(b.shift_m, b.at.normal);
  touch.law_status = is_beyond_moved(b) ? law::LawStatus::kSaturated : b.tip.status;
  touch.energy_J = moved_.energy_J(i);
  // LW-3: what the speed adds, outside of the potential.
  const double resistance_N = scene_.law->resistance_N(indentation_of(b), b.tip.force_N);
  tell_force(i, std::max(1.0 - probe_[i].unsolved_ratio, 0.0) *
                    (b.force_N + b.brake_N +
                     resistance_N * rotated(b.rotation.whole, b.rotation.axis, b.at.normal)));
}

// The force may jump where the organ snaps to another shape, a solution is found again, or the proxy
// meets another side. The told force follows: per tick by at most ten times the stiffest slope times
// the way, plus all of the jump in 0.1 s. While it lags behind a force that is gone, the hand gets
// at most a tenth of the energy that was lost.
void Contact::tell_force(std::size_t i, const Vec3& wanted_N) RT_SAFE {
  constexpr double kSteepest_ratio = 10.0;
  constexpr double kRounding_N = 1e-7;
  Probe& probe = probe_[i];
  SphereTouch& touch = touch_[i];
  const bool is_held = touch.state == TouchState::kHeld;
  // 0: the law does not tell it.
  if (in_contact(i)) probe.stiffest_N_per_m = scene_.law->stiffest_N_per_m(touch.place, is_held);
  const Vec3 change_N = wanted_N - probe.told_N;
  const double length_N = norm(change_N);
  const double of_way_N = kRounding_N + probe.stiffest_N_per_m * kSteepest_ratio * norm(probe.moved_m);
  // Held tissue that is let go or tears is gone at once.
  const bool is_gone = probe.was_held && !is_held && norm(wanted_N) <= norm(probe.told_N);
  probe.lag_N = length_N > of_way_N && probe.stiffest_N_per_m > 0.0 && !is_gone
                    ? std::max(probe.lag_N, length_N)
                    : 0.0;
  const double most_N = of_way_N + probe.lag_N * scene_.period_s / kLetGo_s;
  probe.told_N = probe.lag_N > 0.0 && length_N > most_N
                     ? probe.told_N + (most_N / length_N) * change_N
                     : wanted_N;
  probe.was_held = is_held;
  touch.force_N = probe.told_N;
}

}  // namespace tact::model::contact
