// SPDX-License-Identifier: Apache-2.0
// blade.h - a straight cutting edge, and the surface that it sweeps between two ticks.
//
// The edge is a segment a-b in the tool frame. From one tick to the next it sweeps two triangles,
// (a, b, b') and (a, b', a'); a spring that passes through either is cut. The borders belong to the
// sweep, so there is no gap between two ticks; an edge that does not move cuts nothing.
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

/// Bounding box of a sweep.
struct SweepBox {
  Vec3 low_m{}, high_m{};
};

BladeSweep sweep(const Blade& blade, const Tool& from, const Tool& to) RT_SAFE;
SweepBox box_around(const BladeSweep& sweep) RT_SAFE;

/// True if the segment p-q is entirely outside of one face of the box, so that it does not cross
/// the sweep: six comparisons instead of ten volumes. False for values that are not finite.
bool misses(const SweepBox& box, const Vec3& p_m, const Vec3& q_m) RT_SAFE;

/// True if the segment p-q passes through the triangle a, b, c, borders included.
bool passes(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p, const Vec3& q) RT_SAFE;

/// True if the segment p-q passes through the sweep. False for values that are not finite.
bool crosses(const BladeSweep& sweep, const Vec3& p_m, const Vec3& q_m) RT_SAFE;

}  // namespace tact::model::contact
