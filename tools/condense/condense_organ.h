// SPDX-License-Identifier: Apache-2.0
// condense_organ.h - from a closed surface to its ComplianceMap: fill with gmsh, condense.
#pragma once

#include <string>

#include "model/fem/condensation.h"
#include "model/mesh/mesh.h"
#include "model/result.h"
#include "model/scene/scene.h"
#include "model/tissue/compliance_map.h"

namespace tact::tools::condense {

struct CondenseSettings {
  /// Edge of an element inside the body; 0: 1.5 median edges of the surface.
  double mesh_size_m = 0.0;
  /// a0; 0: 1.6 times the larger of mesh size and median edge.
  double patch_radius_m = 0.0;
  /// Its patch radius is set from the above.
  model::fem::CondensationSettings organ{};
};

/// An organ to condense, in its own frame.
struct CondenseInput {
  model::mesh::SurfaceMesh surface;
  CondenseSettings settings{};
  std::uint32_t inclusions = 0;  // what the map says of its lumps
};

/// What was built, for people.
struct CondenseFacts {
  std::size_t nodes = 0, elements = 0;
  double mesh_size_m = 0.0;
};

/// The scene's organ and [elastic]. An error if the scene lacks the section.
model::Result<CondenseInput> condense_input(const model::scene::Scene& scene);

/// Median length of the edges, m.
double median_edge_m(const model::contact::SurfaceView& surface);

/// Minutes for a few thousand vertices. An error if the surface is open, gmsh fails, or it was
/// interrupted.
model::Result<model::tissue::ComplianceMap> condense_organ(const CondenseInput& input,
                                                           CondenseFacts& facts);

}  // namespace tact::tools::condense
