// SPDX-License-Identifier: Apache-2.0
// RestContact: hold and release by the grip, and the pulling force.
#include <algorithm>
#include <cmath>

#include "model/contact/rest_contact.h"

namespace tact::model::contact {

// A sphere without indentation, in the indentation of another sphere, is not bonded.
bool RestContact::hold(std::size_t i) RT_SAFE {
  RestSphere& s = sphere_[i];
  if (!(pressing_[i].in.indentation_m > 0.0)) return false;
  // The depth continues from its present value, so gripping changes no force.
  s.held_centre_m = s.centre_m;
  s.compliance_triangle = kNoTriangle;  // the compliance of held tissue is smaller
  s.held_depth_m = pressing_[i].depth_m;
  s.is_held = is_newly_held_ = true;
  return true;
}

double RestContact::pull_N(std::size_t i) const RT_SAFE {
  return std::hypot(std::max(0.0, -pressing_[i].response.law.force_N),
                    norm(shear_.force_N(shift_m_, i)));
}

// MC-8   d' = max d in 0 .. min(d_now, d_held) with W(d) <= W_held
// Returns the sphere to the surface without tangential displacement, no deeper than it was held.
// Tissue may be stiffer at the new surface point, so the depth is the largest at which all spheres
// store no more energy than before. The law keeps its relaxation state: without it the force would
// rise.
bool RestContact::release(std::size_t i) RT_SAFE {
  // MC-8: 1/4096 of the depth. Few, as each solves for all spheres.
  constexpr int kHalvings = 12;
  RestSphere& s = sphere_[i];
  PressingSphere& pressing = pressing_[i];
  const double held_J = energy_J_, held_m = pressing.depth_m;
  // Already pulled out of the surface.
  if (!(s.reach_m > 0.0)) {
    leave(i);
    scene_.law->leave(i);
    couple_new_spheres();
    press();
    return false;
  }
  s.is_held = false;
  move_to_proxy(i);
  const auto affords = [&](double depth_m) RT_SAFE {
    pressing.in.indentation_m += depth_m - pressing.depth_m;
    pressing.depth_m = depth_m;
    press();
    return energy_J_ <= held_J;
  };
  double low_m = 0.0, high_m = std::max(0.0, std::min(s.reach_m, held_m));
  if (affords(high_m)) low_m = high_m;
  for (int k = 0; k < kHalvings && low_m < high_m; ++k) {  // bound: kHalvings (of the depth)
    const double middle_m = 0.5 * (low_m + high_m);
    (affords(middle_m) ? low_m : high_m) = middle_m;
  }
  s.depth_offset_m = s.reach_m - low_m;
  if (!(low_m > 0.0)) scene_.law->leave(i);
  // The last depth tried may differ from low_m: compute responses and indentations at low_m.
  affords(low_m);
  drop_shift(i);
  return true;
}

}  // namespace tact::model::contact
