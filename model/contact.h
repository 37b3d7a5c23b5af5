// contact.h - probe spheres on a tool against the surface of an organ.
//
// Each sphere feels one site, in one of three states with one potential each (c: sphere centre,
// r: its radius, phi: signed distance of c to the undeformed surface, n = grad phi):
//
//   free      W = 0
//   touching  W = U(d - slack) + k_t |t|^2 / 2,   d = r - phi,   |k_t t| <= mu F   (Coulomb cap)
//   held      W = U(d)         + k_t |t|^2 / 2,   d and t measured in the frame of the moment of
//             gripping, no cap, d may be negative (pull); ends when the grip opens or when the
//             pulling force passes the tear force
//
//   force on the tool  F = -grad W,  torque = sum (c - origin) x F
//
// t: tangential displacement of the tissue, m. Changes of state never add energy: slack takes up
// whatever depth the new state would have for free, and shrinks only as the tool withdraws.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "model/fault.h"
#include "model/law.h"
#include "model/site.h"
#include "model/types.h"

namespace tact::model {

inline constexpr std::size_t kMaxSpheres = 4;

struct ProbeSphere {
  Vec3 offset_m;          // from the tool's origin, tool frame
  double radius_m = 0.0;  // > 0
};

struct ContactParameters {
  double friction_ratio = 0.0;             // mu, >= 0
  double sliding_stiffness_N_per_m = 0.0;  // k_t, >= 0
  double tear_force_N = 0.0;               // > 0
  double grip_close_ratio = 0.7;           // closing above this holds
  double grip_open_ratio = 0.5;            // opening below this lets go
};

enum class TouchState : std::uint8_t { kFree, kTouching, kHeld };

/// One sphere's share of a tick, for telemetry and tests.
struct SphereTouch {
  TouchState state = TouchState::kFree;
  LawStatus law_status = LawStatus::kNoContact;
  Vec3 surface_point_m;  // nearest (touching) or held point of the undeformed surface
  Vec3 normal;           // outward
  Vec3 shift_m;          // t
  double depth_m = 0.0;  // the law's argument
  double slack_m = 0.0;
  double energy_J = 0.0;  // W
  Vec3 force_N;           // on the tool
};

}  // namespace tact::model
