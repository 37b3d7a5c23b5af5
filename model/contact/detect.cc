// SPDX-License-Identifier: Apache-2.0
// Where each sphere is, from tick to tick, on any path: see contact.h.
//
//     found outside   -> free        found overlapping the organ -> inside
//     free            -> touching    the nearest point of all is nearer than r
//     inside          -> free        wholly outside: phi >= r
//     touching        -> free        r - phi - slack <= 0 at the proxy; at once touching again,
//                                    with slack, where some part of the organ is nearer than r
//     touching        -> lets go     wholly outside, and either beyond its law or with nothing of
//                                    the organ between it and its place: its depth shrinks to 0
//     lets go         -> free
#include <algorithm>
#include <cmath>
#include <limits>

#include "model/contact/contact.h"

namespace tact::model::contact {
namespace {

// The way of one step, of a radius: no sphere passes a sheet between two steps.
constexpr double kSubstep_ratio = 0.5;
constexpr int kMaxSubsteps = 64;  // of a tick, for each period
constexpr double kRounding_m = 1e-9;

/// On the straight way between two poses.
Tool between(const Tool& from, const Tool& to, double share) RT_SAFE {
  const Quat &a = from.orientation, &b = to.orientation;
  // q and -q are one orientation: the shorter way.
  const double sign = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < 0.0 ? -1.0 : 1.0;
  const auto mix = [&](double p, double q) RT_SAFE { return (1.0 - share) * p + share * q; };
  Quat turn{mix(a.w, sign * b.w), mix(a.x, sign * b.x), mix(a.y, sign * b.y), mix(a.z, sign * b.z)};
  const double size =
      std::sqrt(turn.w * turn.w + turn.x * turn.x + turn.y * turn.y + turn.z * turn.z);
  if (size > 0.0) turn = {turn.w / size, turn.x / size, turn.y / size, turn.z / size};
  return {.position_m = (1.0 - share) * from.position_m + share * to.position_m,
          .orientation = turn,
          .velocity_mps = to.velocity_mps,
          .angular_velocity_radps = to.angular_velocity_radps,
          .grip_ratio = mix(from.grip_ratio, to.grip_ratio)};
}

Vec3 centre_of(const ProbeSphere& sphere, const Tool& tool) RT_SAFE {
  return tool.position_m + rotate(tool.orientation, sphere.offset_m);
}

}  // namespace

void Contact::reset() RT_SAFE {
  forget();
  pressing_ = {};
  in_contact_ = {};
  coupling_ = {};
  energy_J_ = 0.0;
  shear_ = {};
  moved_.reset();
  closed_ = closing_ = false;
}

// No sphere is known to be anywhere, nor the blade: it cuts nothing on a way that nobody saw.
void Contact::forget() RT_SAFE {
  for (std::size_t i = 0; i < kMaxSpheres; ++i) {
    probe_[i] = {};
    leave(i, TouchState::kFree);
  }
  tool_before_.reset();
  blade_tool_before_.reset();
}

void Contact::touch(const Tool& tool, std::uint32_t periods, double reach_m) RT_SAFE {
  is_lost_ = was_unsettled_ = false;
  // A pose that is no number touches nothing, and leaves no memory that could be no number.
  if (!is_finite(tool)) return forget();
  if (tool_before_ && !is_reached(tool, reach_m)) {
    is_lost_ = true;
    forget();
  }
  const Tool from = tool_before_.value_or(tool);
  for (std::uint32_t k = 1; k < periods; ++k) {
    const Tool way = between(from, tool, static_cast<double>(k) / periods);
    detect(way);
    if (respond(way).is_unsettled) was_unsettled_ = true;
  }
  detect(tool);
  tool_before_ = tool;
}

// Can the way from the last pose be followed?
bool Contact::is_reached(const Tool& tool, double reach_m) const RT_SAFE {
  if (!(norm(tool.position_m - tool_before_->position_m) <= reach_m)) return false;
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i) {
    const double way_m = norm(centre_of(scene_.spheres[i], tool) - probe_[i].centre_m);
    if (!(way_m <= kMaxSubsteps * kSubstep_ratio * scene_.spheres[i].radius_m)) return false;
  }
  return true;
}

void Contact::detect(const Tool& tool) RT_SAFE {
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i) {
    Probe& probe = probe_[i];
    const Vec3 centre_m = centre_of(scene_.spheres[i], tool);
    probe.moved_m = probe.is_known ? centre_m - probe.centre_m : Vec3{};
    probe.velocity_mps =
        tool.velocity_mps + cross(tool.angular_velocity_radps, centre_m - tool.position_m);
    probe.unpaid_m = 0.0;
    const double radius_m = scene_.spheres[i].radius_m;
    const int steps =
        std::clamp(static_cast<int>(std::ceil(norm(probe.moved_m) / (kSubstep_ratio * radius_m))),
                   1, kMaxSubsteps);
    for (int left = steps; left > 0; --left) {
      const Vec3 to_go_m = probe.is_known ? centre_m - probe.centre_m : Vec3{};
      probe.centre_m = left > 1 ? probe.centre_m + to_go_m / left : centre_m;
      step(i, to_go_m / left);
    }
    if (bends()) {
      moved_.move(i, centre_m, probe.velocity_mps);
      continue;
    }
    probe.depth_m = in_contact(i) ? radius_m - probe.proxy.site().distance_m : 0.0;
  }
}

// One step of a sphere whose centre has moved.
void Contact::step(std::size_t i, const Vec3& moved_m) RT_SAFE {
  Probe& probe = probe_[i];
  probe.clear_m -= norm(moved_m);
  if (!probe.is_known) return find(i);
  switch (touch_[i].state) {
    case TouchState::kFree:
      return begin_from_outside(i, moved_m);
    case TouchState::kInside:
      if (is_outside(i)) leave(i, TouchState::kFree);
      return;
    case TouchState::kTouching:
    case TouchState::kHeld:
      if (bends()) return step_moved(i, moved_m);
      probe.proxy.follow(scene_.surface, probe.centre_m, moved_m, scene_.spheres[i].radius_m);
      probe.unpaid_m += probe.proxy.lengthened_m();
      if (touch_[i].state == TouchState::kHeld || (is_near(i) && !is_all_slack(i))) return;
      leave(i, TouchState::kFree);
      return begin_from_outside(i, moved_m);
  }
}

// Where a sphere is of which nothing is known.
void Contact::find(std::size_t i) RT_SAFE {
  leave(i, TouchState::kFree);
  probe_[i].near = kNoTriangle;
  probe_[i].is_known = true;
  if (!is_outside(i)) touch_[i].state = TouchState::kInside;
}

// Where no sheet was near, the search rests until the sphere may have come to one.
void Contact::begin_from_outside(std::size_t i, const Vec3& moved_m) RT_SAFE {
  Probe& probe = probe_[i];
  if (probe.clear_m > 0.0) return;
  const double radius_m = scene_.spheres[i].radius_m;
  const bool is_new_place = std::isinf(probe.clear_m);  // it has just left another
  const double most_m = -probe.clear_m;                 // as deep as its movement may have led it
  const double within_m = is_new_place ? kAnywhere_m : (1.0 + kAhead_ratio) * radius_m;
  const Site site = nearest_site(scene_.tree, scene_.surface, probe.centre_m, within_m, probe.near);
  probe.clear_m = std::min(site.distance_m, within_m) - radius_m;
  probe.near = site.place.triangle;
  if (probe.clear_m > 0.0) return;
  // Deeper: it came through a hole of an open surface, to the inner side.
  if (-probe.clear_m > most_m + kRounding_m) return leave(i, TouchState::kInside);
  // From where it is known to have been clear, its movement explains all of the depth.
  if (is_new_place)
    probe.unpaid_m = std::max(0.0, -probe.clear_m - std::max(0.0, -dot(moved_m, site.normal)));
  probe.clear_m = 0.0;
  touch_[i].state = TouchState::kTouching;
  if (bends())
    return begin_moved(i, site,
                       is_new_place ? std::max(0.0, -dot(moved_m, site.normal)) : norm(moved_m));
  probe.proxy.restart(site, radius_m);
}

// Is the whole sphere outside? The answer stands until it may have moved out, or in.
bool Contact::is_outside(std::size_t i) RT_SAFE {
  Probe& probe = probe_[i];
  if (probe.clear_m > 0.0) return probe.was_outside;
  const Site site =
      nearest_site(scene_.tree, scene_.surface, probe.centre_m, kAnywhere_m, probe.near);
  probe.near = site.place.triangle;
  const double out_m = site.distance_m - scene_.spheres[i].radius_m;
  probe.clear_m = std::abs(out_m);
  return probe.was_outside = out_m >= 0.0;
}

// Outside, a contact ends: beyond its law on whichever side, else only where nothing of the organ
// is left between the sphere and its place (a thin part that it has pushed ahead stays between).
bool Contact::must_let_go(std::size_t i) RT_SAFE {
  const Probe& probe = probe_[i];
  const bool is_beyond = touch_[i].law_status == law::LawStatus::kSaturated;
  const Site& site = probe.proxy.site();
  // At the nearest point of the side it came from, and nearer than its radius.
  if (!is_beyond && !probe.proxy.lags() && site.distance_m > 0.0) return false;
  if (!is_outside(i)) return false;
  constexpr double kOffSurface_ratio = 1e-3;  // of the way: the place itself is on the surface
  return is_beyond ||
         !is_between(scene_.tree, scene_.surface,
                     site.point_m + kOffSurface_ratio * (probe.centre_m - site.point_m),
                     probe.centre_m);
}

// Its depth shrinks to 0. The force is that of the law's limit until the depth is in its range.
void Contact::let_go(std::size_t i) RT_SAFE {
  Probe& probe = probe_[i];
  SphereTouch& touch = touch_[i];
  if (touch.law_status != law::LawStatus::kSaturated && !probe.lets_go)
    probe.within_law_m = touch.dent_m;
  probe.lets_go = probe.lets_go || must_let_go(i);
  if (!probe.lets_go) return;
  const double less_m =
      kSlide_ratio * norm(probe.moved_m) + probe.within_law_m * scene_.period_s / kLetGo_s;
  const double left_m = std::max(0.0, std::min(touch.dent_m, probe.within_law_m) - less_m);
  const double sunk_m = left_m > 0.0 ? touch.depth_m - touch.dent_m : 0.0;  // by the others
  touch.slack_m = std::max(touch.slack_m, probe.depth_m - left_m - sunk_m);
}

}  // namespace tact::model::contact
