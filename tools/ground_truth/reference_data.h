// SPDX-License-Identifier: Apache-2.0
// reference_data.h - what an elastic organ does at some sites, solved by tact-lab reference.
//
// Signs as in a law: depth > 0 presses, < 0 pulls; force has the sign of the depth; the profile is
// the displacement into the tissue along the site's direction, averaged over the surface ring whose
// points are k ring pitches away from the site (straight distance, undeformed), k = 0, 1, ...
// Press is a rigid frictionless sphere, pull a bonded disc, both of the tool's radius. The body is
// linear elastic, or neo-Hookean with the same E and nu where `large_strain`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/result.h"
#include "model/types.h"
#include "tools/ground_truth/solved_body.h"

namespace tact::tools::ground_truth {

struct ReferenceCase {
  double depth_m = 0.0;
  bool large_strain = false;
  double force_N = 0.0;
  double contact_radius_m = 0.0;   // at rest; at large strain of the final contact area
  double force_error_ratio = 0.0;  // of the mesh: what refinement would change; NaN: not known
  std::vector<double> profile_m;   // ring k at radius k * ring_pitch_m

  bool is_press() const { return depth_m > 0.0; }
};

struct SolvedSite {
  std::uint32_t vertex = 0;          // of the organ's mesh
  model::Vec3 point_m{};             // in the mesh's own frame
  model::Vec3 direction{};           // into the tissue, unit
  std::vector<ReferenceCase> cases;  // linear press and pull, then large; by depth
};

struct ReferenceData {
  SolvedBody body;
  double tool_radius_m = 0.0;
  double ring_pitch_m = 0.0;
  std::vector<SolvedSite> sites;
};

/// An error names the file and the key.
model::Result<ReferenceData> read_reference(const std::string& path);

}  // namespace tact::tools::ground_truth
