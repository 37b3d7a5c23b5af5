// SPDX-License-Identifier: Apache-2.0
// obj_parser.h - the text of a Wavefront OBJ file as vertices and faces, nothing checked yet.
//
// Read: v (x y z; a weight after it is checked and dropped; red, green and blue of 0 to 1 after it
// are the vertex's colour) and f (v, v/vt, v//vn, v/vt/vn; counted from 1, or from the end when
// negative). Comments, names, groups, texture coordinates, normals, lines and free-form curves are
// skipped; a word that OBJ does not know is an error: then this is no OBJ file. Numbers never
// depend on the locale. Set-up code only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "model/mesh/rgb.h"
#include "model/result.h"
#include "model/types.h"

namespace tact::model::mesh {

inline constexpr std::size_t kMaxObjVertices = 10'000'000;
inline constexpr std::size_t kMaxObjTriangles = 20'000'000;
inline constexpr std::size_t kMaxFaceCorners = 1000;
inline constexpr double kMaxObjCoordinate = 1e12;  // file units

struct ObjText {
  std::vector<Vec3> vertex;              // n, file units
  std::vector<Rgb> color;                // n, or none where a vertex has no colour
  std::vector<std::uint32_t> corner;     // vertex numbers of all faces, counted from 0
  std::vector<std::uint32_t> face_end;   // f, into corner
  std::vector<std::uint32_t> face_line;  // f, line of the file, counted from 1
  std::size_t lines = 0;                 // in the file
};

/// `name` is what error messages call the file.
Result<ObjText> parse_obj(std::string_view text, const std::string& name);

}  // namespace tact::model::mesh
