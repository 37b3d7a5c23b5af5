// SPDX-License-Identifier: Apache-2.0
// contact.h - probe spheres on a tool against the surface of an organ.
//
// Each sphere feels one contact point, in one of four states (detect.h says what leads from one to
// another):
//
//   free      no force
//   touching  the organ's answer (organ_contact.h): the negative gradient of one potential W
//   held      likewise, bonded to the place where the grip closed: it may pull. It ends when the
//             grip opens or when the pulling force passes the tear force
//   inside    no contact: it was found in the organ (start, loss), and feels nothing until it has
//             been wholly outside
//
//   force on the tool  F = -grad W,   torque = sum (c - origin) x F,   c: centre of the sphere
//
// A contact begins from outside only, and ends where the sphere is outside: on the side where it
// went in or, beyond the law's range, on any.
//
// A change of state never adds energy. A depth offset cancels penetration that no work has produced
// (release over a bump or stiffer tissue, a nearest point that jumps, a contact that ends on
// another side). The offset shrinks as the tool withdraws, and where a lagging proxy comes nearer:
// the depth stays.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "model/contact/contact_scene.h"
#include "model/contact/moved_contact.h"
#include "model/contact/rest_contact.h"
#include "model/types.h"

namespace tact::model::contact {

/// Chosen: the time in which a contact beyond its law, or without an answer, ends, and in which a
/// force that lags arrives.
inline constexpr double kLetGo_s = 0.1;

/// What the tool feels in a tick.
struct ContactResponse {
  Wrench wrench;
  bool is_saturated = false;  // a sphere is beyond its law (LawStatus::kSaturated), or lets go
  bool is_unsettled = false;  // the force of a sphere lags: its place has no answer, or snaps
  bool is_broken = false;     // see ContactLaw::is_broken
  bool is_inside = false;     // a sphere is inside the organ and feels nothing
  bool is_lost = false;       // in this tick: the tool moved unseen, farther than can be followed
};

class Contact {
 public:
  explicit Contact(const ContactScene& scene);

  /// Where the spheres meet the surface. The tool's way since the last call, `periods` ago, is
  /// followed as a straight line, period by period. What moves farther than reach_m, or than can be
  /// followed, is lost: its contact ends, and it is found again.
  void detect_contact(const Tool& tool, std::uint32_t periods = 1,
                      double reach_m = kAnywhere_m) RT_SAFE;
  /// What the tool feels there: states, laws, forces. Call after touch. A blade cuts only if it
  /// may, and no sphere is inside: nobody would feel it.
  ContactResponse render_force(const Tool& tool, bool blade_may_cut) RT_SAFE;
  /// Forget every contact point, as at the start.
  void reset() RT_SAFE;

  /// See ContactLaw::shape.
  bool shape(PatchShape& out) RT_SAFE { return scene_.law->shape(out); }

  std::span<const SphereContact> contacts() const RT_SAFE {
    return {contact_.data(), scene_.spheres.size()};
  }
  /// The organ as its spheres have moved it, where it bends far.
  const MovedContact& moved() const RT_SAFE { return moved_; }

 private:
  OrganContact& organ() RT_SAFE {
    return scene_.organ != nullptr ? static_cast<OrganContact&>(moved_) : rest_;
  }
  std::span<Sphere> spheres() RT_SAFE { return {sphere_.data(), scene_.spheres.size()}; }
  void forget() RT_SAFE;
  bool is_reached(const Tool& tool, double reach_m) const RT_SAFE;
  void detect(const Tool& tool) RT_SAFE;
  ContactResponse respond(const Tool& tool) RT_SAFE;
  void watch_grip(double grip_ratio) RT_SAFE;
  void let_go(Sphere& sphere) RT_SAFE;
  bool release_first() RT_SAFE;
  void report(Sphere& sphere, const Tool& tool, double way_m, ContactResponse& rendered) RT_SAFE;
  OrganForce ask(Sphere& sphere) RT_SAFE;
  Vec3 resistance_N(const Sphere& sphere, const Vec3& answer_N) const RT_SAFE;
  void follow_force(Sphere& sphere, const Vec3& wanted_N, double way_m) RT_SAFE;
  void use_blade(const Tool& tool, bool may_cut) RT_SAFE;

  ContactScene scene_;
  RestContact rest_;    // of the two, the one that
  MovedContact moved_;  // scene_.organ chooses
  double fade_ratio_;   // ContactLaw::fade_ratio
  std::array<Sphere, kMaxSpheres> sphere_{};
  std::array<SphereContact, kMaxSpheres> contact_{};  // told
  bool closed_ = false;                               // the grip, with hysteresis
  bool closing_ = false;                              // it closed in this tick
  bool is_lost_ = false;                              // in this tick
  bool was_unsettled_ = false;                        // in a period before it that was skipped
  std::optional<Tool> tool_before_;                   // of the last tick
  std::optional<Tool> blade_tool_before_;             // where the blade was
};

}  // namespace tact::model::contact
