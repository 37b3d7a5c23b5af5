// SPDX-License-Identifier: Apache-2.0
// blade.h - a straight cutting edge, and what it passes through between two ticks.
//
// The edge is a segment a-b in the tool frame. From one tick to the next it sweeps two triangles,
// (a, b, b') and (a, b', a'); a spring is cut if it passes through either. Borders belong to the
// sweep, so nothing slips between two ticks; an edge that stands still cuts nothing.
#pragma once

#include "model/types.h"

namespace tact::model::contact {

struct Blade {
  Vec3 a_m{}, b_m{};  // tool frame
};

struct BladeSweep {
  Vec3 from_a_m{}, from_b_m{};  // frame of the surface
  Vec3 to_a_m{}, to_b_m{};
};

/// The least box around a sweep.
struct SweepBox {
  Vec3 low_m{}, high_m{};
};

BladeSweep sweep(const Blade& blade, const Tool& from, const Tool& to) RT_SAFE;
SweepBox box_around(const BladeSweep& sweep) RT_SAFE;

/// Does the segment p-q lie wholly beyond one face of the box? Then it does not cross the sweep:
/// six comparisons in place of ten volumes. False for anything not finite.
bool misses(const SweepBox& box, const Vec3& p_m, const Vec3& q_m) RT_SAFE;

/// Does the segment p-q pass through the triangle a, b, c, its border included?
bool passes(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p, const Vec3& q) RT_SAFE;

/// Does the segment p-q pass through the sweep? False for anything not finite.
bool crosses(const BladeSweep& sweep, const Vec3& p_m, const Vec3& q_m) RT_SAFE;

}  // namespace tact::model::contact
