// SPDX-License-Identifier: Apache-2.0
// MovedContact: which spheres stay in contact, leave, or must end.
#include <algorithm>

#include "model/contact/detect.h"
#include "model/contact/moved_contact.h"

namespace tact::model::contact {
namespace {

// True if the sphere does not overlap the organ at rest.
bool is_free_at_rest(const ContactScene& scene, const Sphere& sphere) RT_SAFE {
  const ContactPoint contact_point = nearest_contact_point(
      scene.tree, scene.surface, sphere.centre_m, sphere.radius_m, sphere.near);
  return !(contact_point.distance_m < sphere.radius_m);
}

}  // namespace

// A pressing sphere stays in contact. For a sphere without force the nearest point is searched
// again: it may be in the indentation of another sphere, at another part of the organ, or outside.
Step MovedContact::step(Sphere& sphere, const Vec3&) RT_SAFE {
  OrganSphere& b = *at(sphere.index);
  if (sphere.unsolved_ratio >= 1.0) return Step::kLost;
  if (b.is_held || b.indentation_m > 0.0) {
    if (!b.is_pressing) sphere.clear_m = -kAnywhere_m;  // from now on for the organ at rest
    b.is_pressing = true;
    return Step::kStays;
  }
  if (b.is_pressing) sphere.clear_m = -kAnywhere_m;
  b.is_pressing = false;
  // Displacement of the organ reduces the clearance, too.
  sphere.clear_m -= norm(b.shift_m - b.seen_shift_m);
  b.seen_shift_m = b.shift_m;
  if (sphere.is_ending) return Step::kLeaves;
  if (sphere.clear_m > 0.0) return Step::kStays;
  const double within_m = (1.0 + kAhead_ratio) * b.radius_m;
  const Vec3 y_m = b.y_m + (sphere.centre_m - b.centre_m);
  const ContactPoint on_organ = nearest_contact_point(scene_.tree, scene_.surface, y_m, within_m,
                                                      b.at.surface_point.triangle);
  sphere.clear_m = std::min(on_organ.distance_m, within_m) - b.radius_m;
  const bool is_elsewhere = norm(on_organ.point_m - b.at.point_m) > b.radius_m;
  const bool leaves = sphere.clear_m > 0.0 ? is_free_at_rest(scene_, sphere) : is_elsewhere;
  return leaves ? Step::kLeaves : Step::kStays;
}

bool MovedContact::is_beyond(const OrganSphere& b) const RT_SAFE {
  return b.tip.status == law::LawStatus::kSaturated || norm(b.shift_m) > scene_.organ->range_m;
}

// True outside of the organ at rest and beyond the law; or outside of the displaced organ, with
// nothing of it between the sphere and its surface point.
bool MovedContact::must_end(Sphere& sphere) RT_SAFE {
  OrganSphere& b = *at(sphere.index);
  if (!(b.indentation_m > 0.0)) return false;
  if (is_beyond(b) && is_outside(scene_, sphere)) return true;
  // Still above its surface point.
  if (b.height_m > -b.radius_m && norm(b.tangential_m) < b.radius_m) return false;
  b.deep_m -= norm(b.y_m - b.seen_y_m);
  b.seen_y_m = b.y_m;
  if (b.deep_m > 0.0) return false;
  const ContactPoint contact_point = nearest_contact_point(
      scene_.tree, scene_.surface, b.y_m, kAnywhere_m, b.at.surface_point.triangle);
  b.deep_m = b.radius_m - contact_point.distance_m;
  return !(b.deep_m > 0.0) && is_open_way(scene_, b.at.point_m, b.y_m);
}

// Returns indentation plus displacement of the organ: both shrink to 0 together.
double MovedContact::cut_to_law_m(std::size_t sphere) RT_SAFE {
  const OrganSphere& b = *at(sphere);
  const double range_m = scene_.organ->range_m;
  const double left_m = std::min(b.indentation_m, range_m) + norm(b.shift_m);
  add_depth_offset(sphere, std::max(0.0, b.indentation_m - range_m));
  return left_m;
}

}  // namespace tact::model::contact
