// rhombus_chain.h - the parallel rhombus-chain law in its energy-consistent form (PHYSICS 1).
//
// N rhombus units in series, four rods of length a each, initial angle theta0, one normal and one
// tangential spring per unit; deeper units have stiffer tangential springs:
//
//     RC-1   s = sin(theta0) - x / 2a,  theta' = asin(s),  c = cos(theta')
//     RC-2   y = x (sin(theta0) + s) / (cos(theta0) + c)
//     RC-3   U = kN x^2 / 2 + kT y^2 / 2          energy of a unit
//     RC-4   f = kN x + kT y s / c                force of a unit, dU/dx
//     RC-5   k = kN + kT (cos(theta0) / c^3 - 1)  its slope
//     RC-8   kT_i = kT1 exp((i - 1) / beta)
//     RC-9   depth = sum x_i, with f_i(x_i) = F for every unit
//     RC-11  u_j = sum of x_i, i > j              profile
//
// x, y in m, f and F in N, press positive. A unit is flat at x = 2a sin(theta0), or snaps before it
// when its tangential spring is stiff (RC-7); the chain saturates at the weakest unit's limit.
#pragma once

#include <array>
#include <cstddef>

#include "model/law.h"
#include "model/result.h"

namespace tact::model {

inline constexpr std::size_t kMaxUnits = 31;

struct RhombusChainParameters {
  double rod_length_m = 0.0;                    // a, > 0
  double initial_angle_rad = 0.0;               // theta0, 0 .. pi/2
  double normal_stiffness_N_per_m = 0.0;        // kN, > 0
  double tangential_stiffness_N_per_m = 0.0;    // kT1, >= 0
  double growth = 0.0;                          // beta, > 0
  std::size_t units = 0;                        // N, 1 .. kMaxUnits
};

}  // namespace tact::model
