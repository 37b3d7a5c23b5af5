// SPDX-License-Identifier: Apache-2.0
// Tissue at rest that a closed grip holds, pulls and loses: see rest_contact.h.
#include <algorithm>
#include <cmath>

#include "model/contact/rest_contact.h"

namespace tact::model::contact {

// A sphere that hangs in the indentation of another has nothing to hold.
bool RestContact::hold(std::size_t i) RT_SAFE {
  RestSphere& s = sphere_[i];
  if (!(pressing_[i].in.indentation_m > 0.0)) return false;
  // The frame of this moment: the depth goes on from what it is, so gripping itself moves nothing.
  s.held_centre_m = s.centre_m;
  s.compliance_triangle = kNoTriangle;  // held, it gives less
  s.held_depth_m = pressing_[i].depth_m;
  s.is_held = is_held_anew_ = true;
  return true;
}

double RestContact::pull_N(std::size_t i) const RT_SAFE {
  return std::hypot(std::max(0.0, -pressing_[i].response.law.force_N),
                    norm(shear_.force_N(shift_m_, i)));
}

// MC-8   d' = max d in 0 .. min(d_now, d_held) with W(d) <= W_held
// Back to the surface, with no stored shift and no deeper than it was held. Tissue may be stiffer
// where the tool has been dragged to. So the depth is the largest at which the whole tool stores no
// more than before. Pressed tissue keeps its memory: relaxation that was forgotten would come back
// as a stiffer push.
bool RestContact::release(std::size_t i) RT_SAFE {
  // MC-8: 1/4096 of the depth. Each one solves the whole tool, so they are few.
  constexpr int kHalvings = 12;
  RestSphere& s = sphere_[i];
  PressingSphere& pressing = pressing_[i];
  const double held_J = energy_J_, held_m = pressing.depth_m;
  // Pulled out already: nothing to go back to.
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
  for (int k = 0; k < kHalvings && low_m < high_m; ++k) {
    const double middle_m = 0.5 * (low_m + high_m);
    (affords(middle_m) ? low_m : high_m) = middle_m;
  }
  s.depth_offset_m = s.reach_m - low_m;
  if (!(low_m > 0.0)) scene_.law->leave(i);
  // Once more, as the last depth tried may be another: answers and indentations become those of
  // low_m.
  affords(low_m);
  drop_shift(i);
  return true;
}

}  // namespace tact::model::contact
