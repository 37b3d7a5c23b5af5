// SPDX-License-Identifier: Apache-2.0
// scene_text.h - the text of a scene for one organ: scene.in with its numbers.
//
//     p_W = p + position,   position = -p_top          p_top: the topmost vertex
//     held:  z <= z_low + (z_high - z_low) / 10        in the frame of the mesh
//     press  at most 0.8 of the working depth, that at most a fifth of the organ's height
#pragma once

#include <string>

#include "model/mesh/mesh.h"
#include "tools/mesh/held_box.h"

namespace tact::tools::new_scene {

struct SceneValues {
  std::string source;     // the organ, as it was named
  std::string name;       // of the scene
  std::string map, tool;  // files beside the scene
  std::string mesh;       // absolute or beside the scene
  std::string law = "compliance";
  bool has_colors = false;  // at the mesh's vertices
  double mesh_unit_m = 0.001;
  double youngs_modulus_Pa = 0.0, poisson_ratio = 0.0;
};

/// What the organ's shape decides.
struct ScenePlacement {
  std::size_t top = 0;  // vertex
  model::Vec3 position_m;
  mesh::HeldBox held;
  double working_depth_m = 0.0;
};

ScenePlacement place_of(const model::mesh::SurfaceMesh& organ);

/// The forceps of the shipped liver, mm.
std::string tool_mesh();

std::string scene_text(const SceneValues& values, const ScenePlacement& place);

}  // namespace tact::tools::new_scene
