// SPDX-License-Identifier: Apache-2.0
// active_set.h - where a rigid body touches an elastic one: pressure only pushes, and nothing lies
// inside.
//
//     p >= 0,   C p >= g,   p . (C p - g) = 0
//
// p pressures, g how far the bodies would overlap without them, C compliance, symmetric and
// positive definite: then there is exactly one solution. Block principal pivoting: all that pulls
// leaves, all that overlaps joins; where that turns in a circle, one at a time, the one with the
// largest number, which ends for every such C.
// Source: J. J. Judice, F. M. Pires, Comput. Oper. Res. 21 (1994) 587.
#pragma once

#include <Eigen/Core>

#include "model/result.h"

namespace tact::tools::reference {

/// An error if C is not positive definite.
model::Result<Eigen::VectorXd> solve_contact(const Eigen::MatrixXd& compliance,
                                             const Eigen::VectorXd& overlap);

}  // namespace tact::tools::reference
