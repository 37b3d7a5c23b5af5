// SPDX-License-Identifier: Apache-2.0
// mesh_report.h - what a person, or a machine, reads about a mesh.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "model/mesh/obj.h"
#include "tools/mesh/place.h"
#include "tools/mesh/repair_file.h"
#include "tools/mesh/unit.h"

namespace tact::tools::mesh {

/// "read             200000 faces, ...", a line.
std::string to_text(const RepairStep& step);
/// How far a long step is, on one line of a terminal that a person watches; nowhere else.
void show_percent(const std::string& step, int percent);
std::string to_text(const model::mesh::ObjMesh& obj, const Unit& unit);

/// SI units. `file`: where it was read; `steps` and `out` are members where there are any.
nlohmann::json to_json(const std::string& file, const Unit& unit, const model::mesh::ObjMesh& obj,
                       const std::vector<RepairStep>& steps, const std::string& out);

/// "note       elastic.fixed_min_m, ...", a line.
std::string to_text(const Misfit& misfit);
/// Unit, orientation and position, as a scene has them, and which of its keys no longer fit.
nlohmann::json to_json(const Placement& placement);

}  // namespace tact::tools::mesh
