// SPDX-License-Identifier: Apache-2.0
// contact.h - contact of the tool's probe spheres with the surface of an organ.
//
// Each sphere has one contact point and one of four states (transitions: detect.h). A sphere that
// is ending is in contact, while its depth shrinks to 0:
//
//   free      no force
//   contact   force from organ_contact.h: the negative gradient of one potential W
//   held      as in contact, bonded to the surface point where the grip closed: the force may pull.
//             Ends when the grip opens or the pulling force exceeds the tear force
//   inside    no force: the sphere was inside the organ at the start or after a loss of contact;
//             ends when the whole sphere is outside
//
//   force on the tool  P = -grad W,   torque = sum (c - origin) x P
//
// A contact begins only from outside. It ends when the sphere is outside again: on the side where
// it entered or, beyond the law's range, on any side.
//
// A change of state never adds energy. A depth offset cancels penetration that no work has produced
// (release over a bump or stiffer tissue, a nearest point that jumps, a contact that ends on
// another side). The offset shrinks as the tool withdraws. It also shrinks by as much as a lagging
// proxy comes nearer, so that the depth does not change.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "model/contact/contact_scene.h"
#include "model/contact/moved_contact.h"
#include "model/contact/rest_contact.h"
#include "model/types.h"

namespace tact::model::contact {

/// Chosen: time in which a contact beyond its law or without a solution ends, and in which a
/// lagging force reaches its target.
inline constexpr double kEnding_s = 0.1;

/// Result of a tick.
struct ContactResponse {
  Wrench wrench;
  bool is_saturated = false;  // a sphere is beyond its law (LawStatus::kSaturated), or is ending
  bool is_unsettled = false;  // the force of a sphere lags after a jump, or has no solution
  bool is_broken = false;     // see ContactLaw::is_broken
  bool is_inside = false;     // a sphere is in state inside, without force
  bool is_lost = false;       // in this tick: the tool's displacement was too long to follow
};

class Contact {
 public:
  explicit Contact(const ContactScene& scene);

  /// Updates the contact points. The motion since the last call, `periods` ago, is simulated as a
  /// straight line, period by period. If the tool has moved farther than reach_m, or a sphere
  /// farther than 64 half radii, all contacts end and all spheres are located again.
  void detect_contact(const Tool& tool, std::uint32_t periods = 1,
                      double reach_m = kAnywhere_m) RT_SAFE;
  /// Updates states and computes forces. Call after detect_contact(). A blade cuts only if
  /// `blade_may_cut` and no sphere is inside, as the cut would give no force.
  ContactResponse render_force(const Tool& tool, bool blade_may_cut) RT_SAFE;
  /// Ends all contacts, as at the start.
  void reset() RT_SAFE;
  /// No sphere is in contact, and no force is left to ramp down.
  bool is_clear() const RT_SAFE;
  /// Takes over the state of `before`, which is out of contact and has the same surface and
  /// spheres: for a tissue with other numbers.
  void continue_from(const Contact& before) RT_SAFE;

  /// See ContactLaw::shape.
  bool shape(PatchShape& out) RT_SAFE { return scene_.law->shape(out); }

  std::span<const SphereContact> contacts() const RT_SAFE {
    return {contact_.data(), scene_.spheres.size()};
  }
  /// The displaced organ, if the scene has a bending organ.
  const MovedContact& moved() const RT_SAFE { return moved_; }

 private:
  OrganContact& organ() RT_SAFE {
    return scene_.organ != nullptr ? static_cast<OrganContact&>(moved_) : rest_;
  }
  std::span<Sphere> spheres() RT_SAFE { return {sphere_.data(), scene_.spheres.size()}; }
  void end_contacts() RT_SAFE;
  void place_spheres(const Tool& tool) RT_SAFE;
  bool is_reached(const Tool& tool, double reach_m) const RT_SAFE;
  void detect(const Tool& tool) RT_SAFE;
  ContactResponse respond(const Tool& tool) RT_SAFE;
  void watch_grip(double grip_ratio) RT_SAFE;
  void end_contact(Sphere& sphere) RT_SAFE;
  bool release_first() RT_SAFE;
  void report(Sphere& sphere, const Tool& tool, double way_m, ContactResponse& rendered) RT_SAFE;
  OrganForce response_of(Sphere& sphere) RT_SAFE;
  Vec3 resistance_N(const Sphere& sphere, const Vec3& answer_N) const RT_SAFE;
  void follow_force(Sphere& sphere, const Vec3& wanted_N, double way_m) RT_SAFE;
  void use_blade(const Tool& tool, bool may_cut) RT_SAFE;

  ContactScene scene_;
  RestContact rest_;                        // used if scene_.organ is null
  MovedContact moved_;                      // used if it is not
  double relaxation_ratio_;                 // ContactLaw::relaxation_ratio
  std::array<Vec3, kMaxSpheres> goal_m_{};  // centres of the spheres at the pose in work
  std::array<Sphere, kMaxSpheres> sphere_{};
  std::array<SphereContact, kMaxSpheres> contact_{};  // as reported
  bool closed_ = false;                               // the grip, with hysteresis
  bool closing_ = false;                              // it closed in this tick
  bool is_lost_ = false;                              // in this tick
  bool was_unsettled_ = false;                        // in a period skipped before this tick
  std::optional<Tool> tool_before_;                   // in the last tick
  std::optional<Tool> blade_tool_before_;             // the same, for the blade
};

}  // namespace tact::model::contact
