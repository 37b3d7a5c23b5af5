// SPDX-License-Identifier: Apache-2.0
// compliance_map.h - how much more than a half-space an organ gives, at every vertex of its
// surface.
//
//     r(s) = C(s) - C_half          regular part of the normal compliance at the place s, m/N
//
// C is the finite-element displacement of the organ under a unit force spread over a patch of
// radius a0, averaged over the patch; C_half is the half-space's under the same patch
// (tools/condense). The singular part, which knows only the patch, cancels: r hardly depends on a0,
// is smooth along the surface, and belongs to the organ alone: its shape, its thickness, where it
// is held. It scales with 1 / E, so the map holds r E, 1/m; it does depend on nu. Above 0 where a
// lobe bends, below 0 near the held side.
//
// A pull that allows no sideways motion also bends less: the map holds the other terms of the 3 x 3
// compliance, in tangential axes that make its lower block diagonal.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/types.h"

namespace tact::model::tissue {

/// Terms of the regular compliance times E, 1/m, beside r: n normal, 1 and 2 tangential axes.
struct SidewaysCompliance {
  float n1 = 0.0F, n2 = 0.0F;                   // normal motion of a sideways force
  float s1 = 0.0F, s2 = 0.0F;                   // sideways motion along the same axis
  std::array<float, 3> axis{1.0F, 0.0F, 0.0F};  // 1, unit, in the mesh's own frame; 2 = n x 1
};

struct ComplianceMap {
  double poisson_ratio = 0.0;   // nu
  double patch_radius_m = 0.0;  // a0
  double ring_pitch_m = 0.0;
  std::size_t rings = 0;                       // N, 1 .. kMaxComplianceRings
  Vec3 fixed_min_m{}, fixed_max_m{};           // held box, in the mesh's own frame
  std::uint32_t inclusions = 0;                // inclusions_hash() of [elastic]
  std::string mesh_hash;                       // surface_hash() of the organ, 16 hex digits
  std::vector<float> regular_times_E_per_m{};  // r E, n vertices
  std::vector<SidewaysCompliance> sideways_times_E_per_m{};  // n
  std::vector<float> ring_times_E_per_m{};  // g_j E of vertex v at [v N + j - 1], j = 1 .. N

  std::size_t vertices() const { return regular_times_E_per_m.size(); }
};

}  // namespace tact::model::tissue
