// SPDX-License-Identifier: Apache-2.0
// obj.h - a Wavefront OBJ file as a sound surface in metres.
//
// Faces with more than three corners are cut into triangles (concave ones too), vertices at exactly
// the same place are welded, vertices that no face uses are dropped, and a closed surface whose
// normals point inwards is turned inside out. Anything that is no surface (mesh_defect.h) is
// refused with the line of the face. An open boundary is allowed. Set-up code only.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/mesh/mesh.h"
#include "model/mesh/rgb.h"
#include "model/result.h"

namespace tact::model::mesh {

inline constexpr std::uintmax_t kMaxObjBytes = 2'000'000'000;

struct ObjMesh {
  SurfaceMesh mesh;                 // m
  std::vector<Rgb> vertex_color;    // of each vertex, or none where one has none
  std::size_t file_vertices = 0;    // in the file
  std::size_t welded_vertices = 0;  // of these, dropped for an earlier one at the same place
  std::size_t unused_vertices = 0;  // of these, dropped because no face names them
  bool flipped = false;             // normals pointed inwards in the file
};

/// How the error of a mesh that is no surface calls its file, where a person cannot open that.
struct ObjErrorText {
  std::string subject, remedy;  // in place of "PATH:LINE:" and of what the flaw asks for
};

/// `unit_m` is the length of one file unit, 1e-9 to 1e3 m.
Result<ObjMesh> load_obj(const std::string& path, double unit_m, const ObjErrorText& text = {});

}  // namespace tact::model::mesh
