// SPDX-License-Identifier: Apache-2.0
// sphere.h - one probe sphere of a tool: what it is, where it is, and what is told of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "model/contact/contact_point.h"
#include "model/contact/contact_settings.h"
#include "model/law/law.h"
#include "model/types.h"

namespace tact::model::contact {

inline constexpr double kAnywhere_m = std::numeric_limits<double>::infinity();

/// detect.h says what leads from one to another. kInside: found in the organ, without contact.
enum class ContactState : std::uint8_t { kFree, kTouching, kHeld, kInside };

/// One sphere's share of a tick.
struct SphereContact {
  ContactState state = ContactState::kFree;
  law::LawStatus law_status = law::LawStatus::kNoContact;
  SurfacePoint surface_point;  // of surface_point_m
  Vec3 surface_point_m{};      // nearest (touching) or held point of the undeformed surface
  Vec3 normal{};               // outward, unit; free: of its last contact
  Vec3 shift_m{};              // t
  double depth_m = 0.0;        // d
  double indentation_m = 0.0;  // e
  double depth_offset_m = 0.0;
  double energy_J = 0.0;  // its share of W
  Vec3 force_N{};         // on the tool; of a contact that has ended it fades
};

/// What contact knows of a sphere, whatever the organ's form (organ_contact.h knows the rest).
struct Sphere {
  std::size_t index = 0;
  double radius_m = 0.0;
  bool is_known = false;  // else it must be found: at the start, after a loss
  ContactState state = ContactState::kFree;
  Vec3 centre_m{};      // c
  Vec3 moved_m{};       // since the last tick
  Vec3 velocity_mps{};  // of c, as the device tells it
  // Its last search
  double clear_m = -kAnywhere_m;     // so far c may go before it must be repeated
  bool was_outside = false;          // what it said of the whole sphere
  std::uint32_t near = kNoTriangle;  // what it found
  // A contact that ends
  bool lets_go = false;
  double shrinks_m = 0.0;       // in 0.1 s
  double unsolved_ratio = 0.0;  // of its last force that it has lost
  // The force that is told, without what its speed adds
  Vec3 reported_N{};
  double largest_N = 0.0;         // that the organ answered in this contact
  double lag_N = 0.0;             // what told_N lacked most of what the organ answers; 0: nothing
  double stiffest_N_per_m = 0.0;  // of its law, when it touched last
  bool was_held = false;

  bool is_in_contact() const RT_SAFE {
    return state == ContactState::kTouching || state == ContactState::kHeld;
  }
};

}  // namespace tact::model::contact
