// SPDX-License-Identifier: Apache-2.0
// repair_file.h - a surface as a scanner or a mesh editor gives it, repaired by VTK.
//
// The work is done by repair.py beside this file, in Debian's own Python, as another program: VTK
// is needed where a mesh is converted and nowhere else, and a damaged file that ends its reader
// ends only that.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "model/mesh/obj.h"
#include "model/result.h"

namespace tact::tools::mesh {

/// How an OBJ file begins that tact-mesh has written.
inline constexpr std::string_view kRepairedBeginning = "# made by tact-mesh\n";

struct RepairOrder {
  std::string source;                // OBJ, STL, PLY, VTK, VTP, OFF, glTF or GLB, by its ending
  std::vector<std::string> options;  // of repair.py
};

struct RepairStep {
  std::string name;    // as its option, without dashes
  std::string text;    // what it did
  std::int64_t count;  // of what the step is about
  std::int64_t faces;  // after it
};

struct Repaired {
  std::vector<RepairStep> steps;
  std::string obj_text;      // in the units of the source
  model::mesh::ObjMesh obj;  // the same, read as tact reads it, with a metre for a unit
};

/// Is this an OBJ file by its name?
bool is_obj(const std::string& path);
/// In metres by its standard.
bool is_gltf(const std::string& path);

/// `on_step` hears of each step when it ends, `on_percent` how far a long one is. An error names
/// the source, and the line where that is known.
model::Result<Repaired> repair_file(const RepairOrder& order,
                                    const std::function<void(const RepairStep&)>& on_step,
                                    const std::function<void(const std::string&, int)>& on_percent);

}  // namespace tact::tools::mesh
