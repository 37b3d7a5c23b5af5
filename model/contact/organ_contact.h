// SPDX-License-Identifier: Apache-2.0
// organ_contact.h - interface: forces of an organ on the spheres that touch it.
//
// Two implementations: the organ's surface stays at rest (rest_contact.h), or the organ has large
// displacements (moved_contact.h). contact.h calls, in each tick in this order: step and move of
// each sphere, must_end, respond, release, hold, finish, report, advance.
#pragma once

#include <cstddef>

#include "model/contact/sphere.h"

namespace tact::model::contact {

/// Forces on a sphere, N.
struct OrganForce {
  Vec3 elastic_N;     // and of friction
  Vec3 resistance_N;  // LW-3, ML-9: by its motion, not part of the potential
};

/// Result of a step for a sphere in contact; kLost: detect it again.
enum class Step : std::uint8_t { kStays, kLeaves, kLost };

class OrganContact {
 public:
  virtual ~OrganContact() = default;
  /// Ends all contacts.
  virtual void reset() RT_SAFE = 0;
  /// Begins a contact near a contact point of the organ at rest. Depth beyond `explained_m`, which
  /// the motion explains, is offset.
  virtual void begin(const Sphere& sphere, const ContactPoint& contact_point,
                     double explained_m) RT_SAFE = 0;
  virtual void leave(std::size_t sphere) RT_SAFE = 0;

  /// One step of the centre of a sphere in contact.
  virtual Step step(Sphere& sphere, const Vec3& moved_m) RT_SAFE = 0;
  /// Sets the position of a sphere in contact for this tick.
  virtual void move(const Sphere& sphere) RT_SAFE = 0;
  /// True if the sphere is outside, and either beyond its law or with nothing of the organ between
  /// it and its surface point.
  virtual bool must_end(Sphere& sphere) RT_SAFE = 0;
  /// Offsets the depth beyond the law's range; returns the remaining depth, m.
  virtual double cut_to_law_m(std::size_t sphere) RT_SAFE = 0;
  /// Reduces the depth of a sphere permanently.
  virtual void add_depth_offset(std::size_t sphere, double depth_m) RT_SAFE = 0;

  /// Computes the forces, after all spheres have moved.
  virtual void respond() RT_SAFE = 0;
  /// Pulling force of a held sphere, N.
  virtual double pull_N(std::size_t sphere) const RT_SAFE = 0;
  /// Releases a held sphere to the surface without adding energy. False: it was pulled out and does
  /// not touch.
  virtual bool release(std::size_t sphere) RT_SAFE = 0;
  /// Bonds a pressing sphere without a change of force. False: it does not press.
  virtual bool hold(std::size_t sphere) RT_SAFE = 0;
  /// Computes tangential forces, after release and hold.
  virtual void finish() RT_SAFE = 0;
  /// False: no solution; forces are those of the last tick.
  virtual bool is_solved() const RT_SAFE = 0;
  /// Fills `reported` except state and force; returns the force of the organ.
  virtual OrganForce report(const Sphere& sphere, SphereContact& reported) const RT_SAFE = 0;
  /// Ends a tick.
  virtual void advance() RT_SAFE = 0;
};

}  // namespace tact::model::contact
