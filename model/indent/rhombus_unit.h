// SPDX-License-Identifier: Apache-2.0
// rhombus_unit.h - one unit of the rhombus chain: four rods of length a, a spring on each diagonal.
//
//     x  shortening of the normal diagonal, m, press positive     f  force, N, press positive
//     y  widening of the tangential diagonal, m                   theta'  angle of the rods, rad
//
// Equations RC-1 .. RC-7; valid from straight rods (x > -2a (1 - sin theta0)) to flat rods
// (x = 2a sin theta0) or, if the tangential spring is stiff, to the snap-through before that.
#pragma once

#include "model/law/law.h"

namespace tact::model::indent {

enum class UnitLimit : std::uint8_t { kFlat, kSnap };

struct RhombusUnit {
  double rod_length_m = 0.0;                  // a
  double initial_angle_rad = 0.0;             // theta0
  double normal_stiffness_N_per_m = 0.0;      // kN
  double tangential_stiffness_N_per_m = 0.0;  // kT

  /// a, kN > 0, 0 < theta0 < pi/2, kT >= 0, all finite.
  bool is_valid() const RT_SAFE;
};

struct UnitResponse {
  double angle_rad = 0.0;         // theta'
  double angle_change_rad = 0.0;  // theta' - theta0
  double lambda = 0.0;            // |theta' - theta0| / theta0, RC-6
  double widening_m = 0.0;        // y
  double force_N = 0.0;           // f
  double stiffness_N_per_m = 0.0;
  double energy_J = 0.0;
  law::LawStatus status = law::LawStatus::kOk;
};

/// RC-7: the largest press of a unit and its force.
struct UnitPressLimit {
  double shortening_m = 0.0;
  double force_N = 0.0;
  UnitLimit kind = UnitLimit::kFlat;
};

UnitPressLimit press_limit(const RhombusUnit& unit) RT_SAFE;
/// Shortening at which the rods are straight, < 0; never reached.
double straight_m(const RhombusUnit& unit) RT_SAFE;
/// RC-1 .. RC-6. Beyond flat: clamped, kSaturated. At or beyond straight: kSingular, zero force.
UnitResponse respond(const RhombusUnit& unit, double shortening_m) RT_SAFE;
/// The root of f(x) = F on the branch through x = 0, F within the unit's limits. Bounded Newton.
double shortening_at(const RhombusUnit& unit, const UnitPressLimit& limit, double force_N) RT_SAFE;

}  // namespace tact::model::indent
