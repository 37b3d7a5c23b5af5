// SPDX-License-Identifier: Apache-2.0
// organ_contact.h - how an organ answers the spheres that touch it.
//
// Two forms: the organ stays as it was drawn (rest_contact.h), or it bends far (moved_contact.h).
// contact.h calls them once a tick in this order: step and move of each sphere, let_go, respond,
// release, hold, finish, tell, advance.
#pragma once

#include <array>
#include <cstddef>

#include "model/contact/sphere.h"

namespace tact::model::contact {

/// Forces on a sphere, N.
struct OrganForce {
  Vec3 elastic_N;     // and of friction
  Vec3 resistance_N;  // LW-3, ML-9: by its movement, outside of the potential
};

/// What a step did to a sphere that touches: kLost is to be found again.
enum class Step : std::uint8_t { kTouches, kLeaves, kLost };

class OrganContact {
 public:
  virtual ~OrganContact() = default;
  /// No sphere touches.
  virtual void reset() RT_SAFE = 0;
  /// A sphere begins to touch near a contact point of the organ at rest. Its depth there beyond
  /// `paid_m` is offset.
  virtual void begin(const Sphere& sphere, const ContactPoint& contact_point,
                     double paid_m) RT_SAFE = 0;
  virtual void leave(std::size_t sphere) RT_SAFE = 0;

  /// One step of the centre of a sphere that touches.
  virtual Step step(Sphere& sphere, const Vec3& moved_m) RT_SAFE = 0;
  /// Where a sphere that touches is in this tick.
  virtual void move(const Sphere& sphere) RT_SAFE = 0;
  /// Is it outside, and either beyond its law or with nothing of the organ between it and its
  /// place?
  virtual bool must_let_go(Sphere& sphere) RT_SAFE = 0;
  /// Depth beyond the law's range becomes offset; returns the depth that is left, m.
  virtual double cut_to_law_m(std::size_t sphere) RT_SAFE = 0;
  /// Its depth becomes smaller, and so it stays.
  virtual void add_depth_offset(std::size_t sphere, double depth_m) RT_SAFE = 0;

  /// When all have moved: the forces of their depths.
  virtual void respond() RT_SAFE = 0;
  /// Pulling force of a held sphere, N.
  virtual double pull_N(std::size_t sphere) const RT_SAFE = 0;
  /// Lets a held sphere go, back to the surface, with no more energy than there was. False: it was
  /// pulled out, and does not touch.
  virtual bool release(std::size_t sphere) RT_SAFE = 0;
  /// Bonds a sphere that presses; no force changes by it. False: it does not press.
  virtual bool hold(std::size_t sphere) RT_SAFE = 0;
  /// After the last of these: forces along the surface.
  virtual void finish() RT_SAFE = 0;
  /// False: the organ has no answer, forces are those of the last tick.
  virtual bool is_solved() const RT_SAFE = 0;
  /// All but the state and the force into `told`; returns the force that the organ answers.
  virtual OrganForce report(const Sphere& sphere, SphereContact& reported) const RT_SAFE = 0;
  /// The end of a tick.
  virtual void advance() RT_SAFE = 0;
};

}  // namespace tact::model::contact
