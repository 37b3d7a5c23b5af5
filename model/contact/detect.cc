// SPDX-License-Identifier: Apache-2.0
#include "model/contact/detect.h"

#include <algorithm>
#include <cmath>

namespace tact::model::contact {
namespace {

// Searches only if the sphere has moved farther than the clearance of the last search.
void begin_from_outside(const ContactScene& scene, OrganContact& organ, Sphere& sphere,
                        const Vec3& moved_m) RT_SAFE {
  constexpr double kRounding_m = 1e-9;
  if (sphere.clear_m > 0.0) return;
  const bool is_new_place = std::isinf(sphere.clear_m);  // it has just left another contact
  const double most_m = -sphere.clear_m;                 // largest depth that its motion explains
  const double within_m = is_new_place ? kAnywhere_m : (1.0 + kAhead_ratio) * sphere.radius_m;
  const ContactPoint contact_point =
      nearest_contact_point(scene.tree, scene.surface, sphere.centre_m, within_m, sphere.near);
  sphere.clear_m = std::min(contact_point.distance_m, within_m) - sphere.radius_m;
  sphere.near = contact_point.surface_point.triangle;
  if (sphere.clear_m > 0.0) return;
  // The sphere came through a hole of an open surface to the inner side.
  if (-sphere.clear_m > most_m + kRounding_m)
    return leave(scene, organ, sphere, ContactState::kInside);
  // If it is known to have been clear, its motion explains all of the depth.
  const double explained_m =
      is_new_place ? std::max(0.0, -dot(moved_m, contact_point.normal)) : kAnywhere_m;
  sphere.clear_m = 0.0;
  sphere.state = ContactState::kInContact;
  organ.begin(sphere, contact_point, std::min(explained_m, norm(moved_m)));
}

// Locates a sphere whose last position is not known.
void find(const ContactScene& scene, OrganContact& organ, Sphere& sphere) RT_SAFE {
  leave(scene, organ, sphere, ContactState::kFree);
  sphere.near = kNoTriangle;
  sphere.is_known = true;
  if (!is_outside(scene, sphere)) sphere.state = ContactState::kInside;
}

}  // namespace

void step(const ContactScene& scene, OrganContact& organ, Sphere& sphere,
          const Vec3& moved_m) RT_SAFE {
  sphere.clear_m -= norm(moved_m);
  if (!sphere.is_known) return find(scene, organ, sphere);
  switch (sphere.state) {
    case ContactState::kFree:
      return begin_from_outside(scene, organ, sphere, moved_m);
    case ContactState::kInside:
      if (is_outside(scene, sphere)) leave(scene, organ, sphere, ContactState::kFree);
      return;
    case ContactState::kInContact:
    case ContactState::kHeld:
      const Step done = organ.step(sphere, moved_m);
      if (done == Step::kStays) return;
      if (done == Step::kLost) return find(scene, organ, sphere);
      leave(scene, organ, sphere, ContactState::kFree);
      return begin_from_outside(scene, organ, sphere, moved_m);
  }
}

void leave(const ContactScene& scene, OrganContact& organ, Sphere& sphere,
           ContactState state) RT_SAFE {
  sphere.state = state;
  sphere.clear_m = -kAnywhere_m;  // not known
  sphere.is_ending = false;
  sphere.unsolved_ratio = 0.0;
  organ.leave(sphere.index);
  scene.law->leave(sphere.index);
}

bool is_outside(const ContactScene& scene, Sphere& sphere) RT_SAFE {
  if (sphere.clear_m > 0.0) return sphere.was_outside;
  const ContactPoint contact_point =
      nearest_contact_point(scene.tree, scene.surface, sphere.centre_m, kAnywhere_m, sphere.near);
  sphere.near = contact_point.surface_point.triangle;
  const double out_m = contact_point.distance_m - sphere.radius_m;
  sphere.clear_m = std::abs(out_m);
  return sphere.was_outside = out_m >= 0.0;
}

bool is_open_way(const ContactScene& scene, const Vec3& surface_point_m,
                 const Vec3& centre_m) RT_SAFE {
  constexpr double kOffSurface_ratio = 1e-3;  // of the line, which starts on the surface
  return !is_between(scene.tree, scene.surface,
                     surface_point_m + kOffSurface_ratio * (centre_m - surface_point_m), centre_m);
}

}  // namespace tact::model::contact
