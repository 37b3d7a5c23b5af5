// SPDX-License-Identifier: Apache-2.0
// organ.h - a mesh from anywhere as one closed part that can be condensed: as it is, or repaired.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "model/mesh/obj.h"
#include "model/result.h"
#include "tools/mesh/repair_file.h"
#include "tools/mesh/unit.h"

namespace tact::tools::new_scene {

struct OrganOrder {
  std::string source;     // any format of tact-mesh
  double unit_m = 0.0;    // 0: the likely one
  std::size_t faces = 0;  // at most about so many
  bool smooth = false;    // take the steps of voxels away
};

struct Organ {
  std::string obj_text;  // repaired, in the units of the source; empty: the source is sound
  mesh::Unit unit;
  model::mesh::SurfaceMesh mesh;  // m, in its own frame
  bool has_colors = false;        // at its vertices
};

/// Is the file an OBJ with one closed part, and small enough?
bool is_sound(const OrganOrder& order);

/// The source if it is sound, else what tact-mesh makes of it. `folder`: for a file meanwhile.
model::Result<Organ> read_organ(const OrganOrder& order, const std::string& folder,
                                const std::function<void(const mesh::RepairStep&)>& on_step,
                                const std::function<void(const std::string&, int)>& on_percent);

}  // namespace tact::tools::new_scene
