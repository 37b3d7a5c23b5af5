// SPDX-License-Identifier: Apache-2.0
// indentation_view.h - what an indented tissue looks like, for telemetry.
//
// Any thread may ask, while the loop's thread drives the same tissue as a ContactLaw
// (contact_law.h): nothing here reads what ContactLaw::respond or advance writes.
#pragma once

#include <cstddef>
#include <span>

#include "model/contact/contact_point.h"
#include "model/contact/contact_settings.h"
#include "model/types.h"

namespace tact::model::contact {

/// What one sphere does to the tissue.
struct Indentation {
  std::size_t sphere = 0;  // below kMaxSpheres
  SurfacePoint surface_point{};
  Vec3 normal{};  // outward, unit, at the place
  // e: the depth, less what the other spheres press down here; below 0 only while held
  double indentation_m = 0.0;
  bool held = false;
  double speed_mps = 0.0;  // of the sphere's depth, pressing positive
};

class IndentationView {
 public:
  virtual ~IndentationView() = default;
  /// Radial displacement profile as in Law::profile; 0: the law tells its shape otherwise
  /// (ContactLaw::shape).
  virtual std::size_t profile(const Indentation& in, std::span<double> ring_m) const RT_SAFE = 0;
  virtual double ring_pitch_m() const RT_SAFE = 0;
  /// CF-5: F t, how the indentation leans along the surface: what the profile lacks at x is this
  /// times the way from the place to x.
  virtual Vec3 tilt(const Indentation& in) const RT_SAFE {
    (void)in;
    return {};
  }
};

}  // namespace tact::model::contact
