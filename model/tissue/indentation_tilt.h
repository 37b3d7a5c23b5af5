// SPDX-License-Identifier: Apache-2.0
// indentation_tilt.h - how the indentation of a contact point leans: an organ sinks more towards a
// free lobe than towards the side where it is held.
//
//     CF-5   u(x) = u(rho) + T(rho) F t . (x - s)
//     CF-6   t = grad r / 2
//
//     u     displacement of the surface, m; u(rho) its mean around the contact point (map's rings)
//     F     force at the contact point s, N      T   the taper of the outer rings (ring_taper)
//     r     compliance of a place beyond a half-space (compliance_map.h), m/N;  t   1/N
//
// G(x, s), displacement of x by a unit force at s, beyond a half-space, is symmetric and r(s) is
// G(s, s): along the surface r changes twice as fast as G does. grad r is that of the plane through
// the r of all surface within kTiltReach_m that looks the same way.
#pragma once

#include <vector>

#include "model/contact/smooth_surface.h"
#include "model/tissue/compliance_map.h"

namespace tact::model::tissue {

/// Small against an organ, large against the facets of its mesh: from 16 to 30 mm all do.
inline constexpr double kTiltReach_m = 0.02;

/// t E of each vertex, 1/m^2, in the axes of the surface. Each vertex is held against those of a
/// slab of twice kTiltReach_m around it.
/// Set-up code only.
std::vector<Vec3> indentation_tilt(const ComplianceMap& map, const contact::SurfaceView& surface);

/// The same at a vertex of an organ that bends, whose slope is known: r = n' G n.
Vec3 tilt_times_E_per_m2(const contact::VertexCompliance& vertex, const Vec3& normal) RT_SAFE;

}  // namespace tact::model::tissue
