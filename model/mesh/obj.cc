// SPDX-License-Identifier: Apache-2.0
#include "model/mesh/obj.h"

#include <fmt/format.h>

#include <bit>

#include "model/io/input_file.h"
#include "model/mesh/mesh_defect.h"
#include "model/mesh/obj_parser.h"
#include "model/mesh/polygon.h"

namespace tact::model::mesh {
namespace {

// The whole text is in memory only while it is parsed.
Result<ObjText> read_obj(const std::string& path) {
  const Result<std::string> file =
      io::read_file(path, "name an OBJ file of at most 2 GB", kMaxObjBytes);
  if (!file) return file.error();
  if (file->empty()) return Error{path + ":1: the file is empty; export the mesh again"};
  Result<ObjText> text = parse_obj(file.value(), path);
  if (text && text->face_end.empty()) {
    return Error{
        fmt::format("{}:{}: the file ends with {} vertices and no faces; "
                    "export the mesh with faces",
                    path, text->lines, text->vertex.size())};
  }
  return text;
}

// Of the bits: welded is only what lies at exactly the same place.
std::uint64_t hash(const Vec3& p) {
  std::uint64_t h = 0;
  for (const double x : {p.x, p.y, p.z}) {
    // 2^64 over the golden ratio: spreads neighbours over the table.
    h = (h ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9E3779B97F4A7C15u;  // + 0.0: -0 is 0
    h ^= h >> 29;
  }
  return h ^ (h >> 32);
}

// For each vertex, the first one at exactly the same place.
std::vector<std::uint32_t> first_at_place(const std::vector<Vec3>& vertex) {
  // A power of two, at most half full: looking up stays short, and the remainder is a mask.
  const std::size_t slots = std::bit_ceil(2 * vertex.size() + 1);
  std::vector<std::uint32_t> table(slots, contact::kNoTriangle);  // open addressing
  std::vector<std::uint32_t> first(vertex.size());
  for (std::uint32_t v = 0; v < vertex.size(); ++v) {
    std::size_t slot = hash(vertex[v]) & (slots - 1);
    while (table[slot] != contact::kNoTriangle && !(vertex[table[slot]] == vertex[v]))
      slot = (slot + 1) & (slots - 1);
    if (table[slot] == contact::kNoTriangle) table[slot] = v;
    first[v] = table[slot];
  }
  return first;
}

// Triangles of welded vertices, and what is needed to speak of them in terms of the file.
struct Triangles {
  std::vector<Vec3> vertex_m;
  std::vector<std::uint32_t> file_vertex;  // of each vertex, counted from 1
  std::vector<contact::TriangleCorners> triangle;
  std::vector<std::uint32_t> line;  // of each triangle
};

// Corners of a polygon that fell on their predecessor by welding, as at the pole of a globe made
// of quads, are dropped; a triangle keeps them and is refused later.
void weld_face(std::span<const std::uint32_t> corner, const std::vector<std::uint32_t>& first,
               std::vector<std::uint32_t>& welded) {
  welded.clear();
  for (std::size_t i = 0; i < corner.size(); ++i) {
    const std::uint32_t before = corner[i == 0 ? corner.size() - 1 : i - 1];
    const bool fell = before != corner[i] && first[before] == first[corner[i]];
    if (!fell || corner.size() == 3) welded.push_back(first[corner[i]]);
  }
  while (welded.size() < 3) welded.push_back(welded.empty() ? first[corner[0]] : welded.back());
}

Triangles cut_faces(const ObjText& text, const std::vector<std::uint32_t>& first) {
  Triangles out;
  out.triangle.reserve(text.face_end.size());
  out.line.reserve(text.face_end.size());
  std::vector<std::uint32_t> welded;
  std::size_t begin = 0;
  for (std::size_t face = 0; face < text.face_end.size(); ++face) {
    const std::size_t end = text.face_end[face];
    weld_face(std::span(text.corner).subspan(begin, end - begin), first, welded);
    cut_polygon(welded, text.vertex, out.triangle);
    out.line.resize(out.triangle.size(), text.face_line[face]);
    begin = end;
  }
  return out;
}

// Numbers the used vertices from 0 in the order of the file, and scales them.
void keep_used_vertices(const ObjText& text, double unit_m, Triangles& out) {
  constexpr std::uint32_t kUnused = 0xFFFFFFFFu;
  std::vector<std::uint32_t> number(text.vertex.size(), kUnused);
  for (const contact::TriangleCorners& t : out.triangle)
    for (const std::uint32_t v : t) number[v] = 0;
  for (std::uint32_t v = 0; v < text.vertex.size(); ++v) {
    if (number[v] == kUnused) continue;
    number[v] = static_cast<std::uint32_t>(out.vertex_m.size());
    out.vertex_m.push_back(text.vertex[v] * unit_m);
    out.file_vertex.push_back(v + 1);
  }
  for (contact::TriangleCorners& t : out.triangle)
    for (std::uint32_t& v : t) v = number[v];
}

// In numbers and lines of the file, which a person can look up.
Error defect_error(const std::string& path, const MeshDefect& defect,
                   const std::vector<std::uint32_t>& line,
                   const std::vector<std::uint32_t>& file_vertex) {
  std::string where;
  if (defect.flaw == MeshFlaw::kSameDirection || defect.flaw == MeshFlaw::kCrowdedEdge) {
    where = fmt::format(" (edge {}-{}, see line {})", file_vertex[defect.from],
                        file_vertex[defect.to], line[defect.other]);
  }
  return {fmt::format("{}:{}: the face {}{}; {}", path, line[defect.triangle], what(defect.flaw),
                      where, remedy(defect.flaw))};
}

// (a, b, c) becomes (a, c, b): the first and the last edge change places.
void turn_inside_out(SurfaceMesh& mesh) {
  for (contact::TriangleCorners& t : mesh.triangle) std::swap(t[1], t[2]);
  for (contact::TriangleCorners& across : mesh.neighbour) std::swap(across[0], across[2]);
  for (Vec3& n : mesh.face_normal) n = -n;
  for (Vec3& n : mesh.vertex_normal) n = -n;
  fill_records(mesh);
}

}  // namespace

Result<ObjMesh> load_obj(const std::string& path, double unit_m, const ObjErrorText& error_text) {
  if (!(unit_m >= 1e-9 && unit_m <= 1e3)) {
    return Error{
        fmt::format("{}: a file unit of {} m is not between 1e-9 m and 1e3 m; "
                    "give 0.001 for millimetres",
                    path, unit_m)};
  }
  const Result<ObjText> parsed = read_obj(path);
  if (!parsed) return parsed.error();
  const ObjText& text = parsed.value();
  const std::vector<std::uint32_t> first = first_at_place(text.vertex);
  Triangles found = cut_faces(text, first);
  keep_used_vertices(text, unit_m, found);
  ObjMesh obj;
  obj.file_vertices = text.vertex.size();
  for (std::uint32_t v = 0; v < first.size(); ++v) obj.welded_vertices += first[v] != v;
  obj.unused_vertices = obj.file_vertices - obj.welded_vertices - found.vertex_m.size();

  if (!text.color.empty())
    for (const std::uint32_t v : found.file_vertex) obj.vertex_color.push_back(text.color[v - 1]);

  SurfaceOrDefect built = build_surface(std::move(found.vertex_m), std::move(found.triangle));
  if (const auto* defect = std::get_if<MeshDefect>(&built)) {
    if (!error_text.subject.empty())
      return Error{fmt::format("{} the face {}; {}", error_text.subject, what(defect->flaw),
                               error_text.remedy)};
    return defect_error(path, *defect, found.line, found.file_vertex);
  }
  obj.mesh = std::move(*std::get_if<SurfaceMesh>(&built));
  const MeshSummary sum = summarize(obj.mesh);
  // An open surface has no volume, so nothing says which side is out: it is left as it is.
  obj.flipped = sum.boundary_edges == 0 && sum.volume_m3 < 0.0;
  if (obj.flipped) turn_inside_out(obj.mesh);
  return obj;
}

}  // namespace tact::model::mesh
