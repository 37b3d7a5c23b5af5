// SPDX-License-Identifier: Apache-2.0
// unit.h - in which unit the numbers of a mesh file are taken, and why.
//
// No format but glTF says its unit. Where none is named, it is the one that makes an organ of the
// mesh: a reader of the result must know it, since a guess may be wrong by a factor of ten.
#pragma once

#include <map>
#include <string>

#include "model/mesh/mesh.h"

namespace tact::tools::mesh {

/// The units that a file of a mesh may have, by name: the length of one, m.
std::map<std::string, double> units_m();

/// mm for an organ of at least 25 units, cm for one of at least 1, else m.
double likely_unit_m(double size_in_file_units);

enum class UnitFrom { kNamed, kFormat, kSize };

struct Unit {
  double unit_m = 0.001;
  UnitFrom from = UnitFrom::kNamed;
};

/// `named_m`: by the user; 0: none. `in_file_units`: the mesh as it is read.
Unit unit_of(const std::string& path, double named_m,
             const model::mesh::SurfaceMesh& in_file_units);

/// "mm", or "0.02 m" of a unit without a name.
std::string name_of(double unit_m);
/// "taken as mm: 210 mm across; --unit sets another". `mesh` in m.
std::string to_text(const Unit& unit, const model::mesh::SurfaceMesh& mesh);
/// For machines: "named", "format" or "size".
std::string to_text(UnitFrom from);

}  // namespace tact::tools::mesh
