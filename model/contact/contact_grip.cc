// SPDX-License-Identifier: Apache-2.0
// When a closed grip holds tissue and when it loses it: see contact.h.
#include <algorithm>
#include <cmath>

#include "model/contact/contact.h"

namespace tact::model::contact {
void Contact::watch_grip(double grip_ratio) RT_SAFE {
  // Two thresholds: a hand that trembles at one would grip and let go many times a second.
  const bool was_closed = closed_;
  if (grip_ratio >= scene_.parameters.grip_close_ratio) closed_ = true;
  if (!(grip_ratio >= scene_.parameters.grip_open_ratio)) closed_ = false;  // NaN opens
  closing_ = closed_ && !was_closed;
}

// Held tissue follows the tool in the frame of this moment. A sphere that hangs in the dent of
// another has nothing to hold.
bool Contact::hold() RT_SAFE {
  bool held = false;
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i) {
    SphereTouch& touch = touch_[i];
    if (touch.state != TouchState::kTouching || !(touch.dent_m > 0.0)) continue;
    Probe& probe = probe_[i];
    // The frame of this moment: the depth goes on from
    // what it is, so gripping itself moves nothing.
    probe.held_centre_m = probe.centre_m;
    probe.held_normal = touch.normal;
    probe.give_triangle = kNoTriangle;  // held, it gives less
    probe.held_depth_m = touch.depth_m;
    touch.state = TouchState::kHeld;
    held = true;
  }
  return held;
}

bool Contact::is_torn(std::size_t i) const RT_SAFE {
  const double pull_N = std::hypot(std::max(0.0, -pressing_[i].response.law.force_N),
                                   norm(shear_.force_N(shift_m_, i)));
  // What is no number tears: it must not hold the tool.
  return !(pull_N <= scene_.parameters.tear_force_N);
}

// The first that must: its going changes what the others feel.
bool Contact::release_first() RT_SAFE {
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i)
    if (touch_[i].state == TouchState::kHeld && (!closed_ || is_torn(i))) {
      release_sphere(i);
      return true;
    }
  return false;
}

// MC-8   d' = max d in 0 .. min(d_now, d_held) with W(d) <= W_held
// Back to the surface, with no stored shift and no deeper than it was held. Tissue may be stiffer
// where the tool has been dragged to. So the depth is the largest at which the whole tool stores no
// more than before. Pressed tissue keeps its memory: relaxation that was forgotten would come back
// as a stiffer push.
void Contact::release_sphere(std::size_t i) RT_SAFE {
  // MC-8: 1/4096 of the depth. Each one solves the whole tool, so they are few.
  constexpr int kHalvings = 12;
  const Probe& probe = probe_[i];
  SphereTouch& touch = touch_[i];
  const double held_J = energy_J_, held_m = touch.depth_m;
  // Pulled out already: nothing to go back to.
  if (!(probe.depth_m > 0.0)) {
    leave(i, TouchState::kFree);
    couple_new_spheres();
    press();
    return;
  }
  touch.state = TouchState::kTouching;
  move_to_proxy(i);
  const auto affords = [&](double depth_m) RT_SAFE {
    touch.dent_m += depth_m - touch.depth_m;
    touch.depth_m = depth_m;
    return press() <= held_J;
  };
  double low_m = 0.0, high_m = std::max(0.0, std::min(probe.depth_m, held_m));
  if (affords(high_m)) low_m = high_m;
  for (int k = 0; k < kHalvings && low_m < high_m; ++k) {
    const double middle_m = 0.5 * (low_m + high_m);
    (affords(middle_m) ? low_m : high_m) = middle_m;
  }
  touch.slack_m = probe.depth_m - low_m;
  if (!(low_m > 0.0)) scene_.law->leave(i);
  // Once more, as the last depth tried may be another: answers and dents become those of low_m.
  affords(low_m);
  // Without it the others share the shift; it goes where they have dragged it.
  Shear without = shear_;
  without.leave(i);
  without.solve();
  Shear::Shifts f_N{};
  for (std::size_t j = 0; j < kMaxSpheres; ++j) f_N[j] = without.force_N(shift_m_, j);
  shift_m_[i] = shear_.unloaded_m(f_N, i);
  start_tangent_spring(i);
  shear_.solve();
}

}  // namespace tact::model::contact
