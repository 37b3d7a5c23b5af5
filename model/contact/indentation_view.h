// SPDX-License-Identifier: Apache-2.0
// indentation_view.h - shape of an indented tissue, for telemetry.
//
// Any thread may call this class while the loop's thread uses the same tissue as a ContactLaw
// (contact_law.h): nothing here reads data that ContactLaw::respond or advance writes.
#pragma once

#include <cstddef>
#include <span>

#include "model/contact/contact_point.h"
#include "model/contact/contact_settings.h"
#include "model/types.h"

namespace tact::model::contact {

/// Indentation of the tissue by one sphere.
struct Indentation {
  std::size_t sphere = 0;  // below kMaxSpheres
  SurfacePoint surface_point{};
  Vec3 normal{};  // outward, unit, at surface_point
  // e: depth minus the coupled displacement by the other spheres; below 0 only while held
  double indentation_m = 0.0;
  bool held = false;
  double speed_mps = 0.0;  // of the sphere's depth, pressing positive
};

class IndentationView {
 public:
  virtual ~IndentationView() = default;
  /// Radial displacement profile as in Law::profile; 0: see ContactLaw::shape.
  virtual std::size_t profile(const Indentation& in, std::span<double> ring_m) const RT_SAFE = 0;
  virtual double ring_pitch_m() const RT_SAFE = 0;
  /// CF-5: F t, slope of the indentation along the surface: at x the profile must be increased by
  /// this times the vector from the surface point to x.
  virtual Vec3 tilt(const Indentation& in) const RT_SAFE {
    (void)in;
    return {};
  }
};

}  // namespace tact::model::contact
