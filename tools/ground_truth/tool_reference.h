// SPDX-License-Identifier: Apache-2.0
// tool_reference.h - what an elastic organ does under the whole tool, solved by tact-lab reference
// --tool.
//
// All spheres of the tool are one rigid body without friction; the organ is linear elastic or,
// with --finite-strain, neo-Hookean. Where:
// the point at which the simulated hand presses, points that its strokes slide to, and some that no
// fit has used. Without friction a slide leaves nothing behind, so it counts as a press at its
// end. The tool comes to each as the hand brings it to its own: turned from its rest by
// `orientation`, the shortest turn from the hand's way in to `direction`. At depth d its lowest
// point, seen along `direction`, lies d beyond `point_m`: depths are those of a press stroke.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/contact/contact.h"
#include "model/result.h"
#include "model/types.h"
#include "tools/ground_truth/solved_body.h"

namespace tact::tools::ground_truth {

struct ToolCase {
  double depth_m = 0.0;
  double force_N = 0.0;            // on the tool against the direction
  std::vector<double> sphere_N;    // of each sphere
  double force_error_ratio = 0.0;  // of the mesh: what refinement would change; NaN: not known
  std::vector<double> skin_m{};    // how far each vertex of the place's `skin` goes along the way
};

struct ToolPoint {
  std::optional<std::uint32_t> vertex;  // of the organ's mesh; none: the hand's own site, slid
  model::Vec3 slid_m{};                 // from the hand's own site by a stroke, 0: not
  double tilt_deg = 0.0;                // the tool is turned so far at the hand's own site
  model::Vec3 point_m{};                // of the tool's lowest point at depth 0, mesh's own frame
  model::Vec3 direction{};              // into the tissue, unit
  model::Quat orientation{};
  std::vector<std::uint32_t> skin{};  // vertices of the organ's mesh, where asked for
  std::vector<ToolCase> cases;        // by depth, the same at every place
};

struct ToolReference {
  SolvedBody body;
  std::vector<model::contact::ProbeSphere> sphere;  // tool frame
  std::vector<ToolPoint> places;
};

/// "hand's", "slid 10 mm", "tilted 20", "1586"
std::string name_of(const ToolPoint& place);

/// An error names the file and the key.
model::Result<ToolReference> read_tool_reference(const std::string& path);

}  // namespace tact::tools::ground_truth
