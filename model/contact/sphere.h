// SPDX-License-Identifier: Apache-2.0
// sphere.h - one probe sphere of a tool: geometry, state, and the contact that is reported.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "model/contact/contact_point.h"
#include "model/contact/contact_settings.h"
#include "model/contact_state.h"
#include "model/law/law.h"
#include "model/types.h"

namespace tact::model::contact {

inline constexpr double kAnywhere_m = std::numeric_limits<double>::infinity();

/// Reported contact of one sphere in a tick.
struct SphereContact {
  ContactState state = ContactState::kFree;
  law::LawStatus law_status = law::LawStatus::kNoContact;
  SurfacePoint surface_point;  // of surface_point_m
  Vec3 surface_point_m{};      // nearest (in contact) or held point of the undeformed surface
  Vec3 normal{};               // outward, unit; free: of its last contact
  Vec3 shift_m{};              // t
  double depth_m = 0.0;        // d
  double indentation_m = 0.0;  // e
  double depth_offset_m = 0.0;
  double energy_J = 0.0;  // its share of W
  Vec3 force_N{};         // on the tool; may ramp down after the contact has ended
};

/// State of a sphere that is common to both implementations of organ_contact.h.
struct Sphere {
  std::size_t index = 0;
  double radius_m = 0.0;
  bool is_known = false;  // false at the start and after a loss: it must be located
  ContactState state = ContactState::kFree;
  Vec3 centre_m{};      // c
  Vec3 moved_m{};       // since the last tick
  Vec3 velocity_mps{};  // of c, from the device's sample
  // Its last search
  double clear_m = -kAnywhere_m;     // distance that c may move before a new search
  bool was_outside = false;          // the whole sphere was outside
  std::uint32_t near = kNoTriangle;  // nearest triangle
  // A contact that ends
  bool is_ending = false;
  double shrinks_m = 0.0;       // in 0.1 s
  double unsolved_ratio = 0.0;  // how far its last force has ramped down, 0 to 1
  // The reported force, without resistance
  Vec3 reported_N{};
  double largest_N = 0.0;         // largest force of the organ in this contact
  double lag_N = 0.0;             // largest lag of reported_N behind the organ's force; 0: no lag
  double stiffest_N_per_m = 0.0;  // of its law, at the last contact
  bool was_held = false;

  bool is_in_contact() const RT_SAFE {
    return state == ContactState::kInContact || state == ContactState::kHeld;
  }
};

}  // namespace tact::model::contact
