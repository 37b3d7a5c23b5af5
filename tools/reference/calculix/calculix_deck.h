// SPDX-License-Identifier: Apache-2.0
// calculix_deck.h - an elastic problem as the text that CalculiX reads.
//
// Units are mm, kPa and mN: CalculiX's tolerances suit numbers near one.
//
// A ball touches by mortar contact (S. Sitzmann, K. Willner, B. Wohlmuth, Int. J. Numer. Meth.
// Engng 103 (2015) 60): pressure is weighted over faces, not collected at nodes, so it holds on the
// quadratic faces of C3D10 and at large sliding. CalculiX keeps the direction of a contact through
// a step, so a ball goes by a tenth of its radius at a time: at two radii deep, steps of a fifth
// give 3 % more force, of a twentieth 1 % less.
#pragma once

#include <string>

#include "tools/reference/calculix/calculix.h"

namespace tact::tools::reference {

inline constexpr double kMmPerM = 1e3;
inline constexpr double kNPerMN = 1e-3;

/// Right-handed, x along a direction. The deck has these axes, so that a moved node needs no
/// equation between its coordinates.
struct DeckAxes {
  model::Vec3 x{}, y{}, z{};

  model::Vec3 to_deck(const model::Vec3& v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
  model::Vec3 from_deck(const model::Vec3& v) const { return v.x * x + v.y * y + v.z * z; }
};
DeckAxes deck_axes(const model::Vec3& direction);

/// Prints forces of the set MOVED (with a ball: HELD) and displacements of the set REPORTED, at the
/// end of the way.
std::string deck_of(const ElasticProblem& problem);

}  // namespace tact::tools::reference
