// SPDX-License-Identifier: Apache-2.0
#include "model/mesh/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "model/mesh/mesh_defect.h"

namespace tact::model::mesh {
namespace {

constexpr std::size_t kMaxTriangles = 1'000'000'000;  // 3 m must fit 32 bits

// Collinear corners leave a cross product of pure rounding, about 1e-14 of the longest edge squared
// for coordinates a hundred edges away from the origin. Honest slivers are far above this.
constexpr double kFlat_ratio = 1e-10;

// One triangle's edge, filed under the vertex where it starts.
struct HalfEdge {
  std::uint32_t to = 0;
  std::uint32_t id = 0;  // 3 * triangle + edge

  friend auto operator<=>(const HalfEdge&, const HalfEdge&) = default;
};

// a x b of two edges: twice the area vector, counter-clockwise outward.
Vec3 doubled_area_m2(const std::vector<Vec3>& vertex_m, const contact::TriangleCorners& t) {
  return cross(vertex_m[t[1]] - vertex_m[t[0]], vertex_m[t[2]] - vertex_m[t[0]]);
}

// What is wrong with a triangle by itself.
std::optional<MeshFlaw> corner_flaw(const std::vector<Vec3>& vertex_m,
                                    const contact::TriangleCorners& t) {
  double longest2_m2 = 0.0;
  for (std::size_t e = 0; e < 3; ++e) {
    // All corners before any arithmetic with them.
    if (t[e] >= vertex_m.size()) return MeshFlaw::kMissingVertex;
    if (!is_finite(vertex_m[t[e]])) return MeshFlaw::kNotFinite;
  }
  for (std::size_t e = 0; e < 3; ++e) {
    const std::size_t next = (e + 1) % 3;
    if (t[e] == t[next]) return MeshFlaw::kRepeatedCorner;
    const Vec3 edge_m = vertex_m[t[next]] - vertex_m[t[e]];
    longest2_m2 = std::max(longest2_m2, dot(edge_m, edge_m));
  }
  const double doubled_m2 = norm(doubled_area_m2(vertex_m, t));
  if (!(doubled_m2 > kFlat_ratio * longest2_m2)) return MeshFlaw::kZeroArea;
  return std::nullopt;
}

// fan_start and fan by counting sort: the triangles around each vertex, ascending.
void fill_fans(SurfaceMesh& mesh) {
  mesh.fan_start.assign(mesh.vertex_m.size() + 1, 0);
  for (const contact::TriangleCorners& t : mesh.triangle)
    for (const std::uint32_t v : t) ++mesh.fan_start[v + 1];
  for (std::size_t v = 0; v < mesh.vertex_m.size(); ++v) mesh.fan_start[v + 1] += mesh.fan_start[v];
  mesh.fan.resize(3 * mesh.triangle.size());
  std::vector<std::uint32_t> next(mesh.fan_start.begin(), mesh.fan_start.end() - 1);
  for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t)
    for (const std::uint32_t v : mesh.triangle[t]) mesh.fan[next[v]++] = t;
}

// Every triangle around a vertex has one edge that starts there, so the fans give the places.
// Sorted by end, so that a vertex with a million triangles still costs n log n.
std::vector<HalfEdge> sorted_half_edges(const SurfaceMesh& mesh) {
  std::vector<HalfEdge> half_edge(mesh.fan.size());
  for (std::uint32_t v = 0; v < mesh.vertex_m.size(); ++v) {
    for (std::uint32_t i = mesh.fan_start[v]; i < mesh.fan_start[v + 1]; ++i) {
      const std::uint32_t t = mesh.fan[i];
      const contact::TriangleCorners& corner = mesh.triangle[t];
      const std::uint32_t e = corner[0] == v ? 0u : corner[1] == v ? 1u : 2u;
      half_edge[i] = {.to = corner[(e + 1) % 3], .id = 3 * t + e};
    }
    std::sort(half_edge.begin() + mesh.fan_start[v], half_edge.begin() + mesh.fan_start[v + 1]);
  }
  return half_edge;
}

// All half edges from one vertex to another.
std::span<const HalfEdge> run(const SurfaceMesh& mesh, const std::vector<HalfEdge>& half_edge,
                              std::uint32_t from, std::uint32_t to) {
  const auto first = half_edge.begin() + mesh.fan_start[from];
  const auto last = half_edge.begin() + mesh.fan_start[from + 1];
  const auto low = std::lower_bound(first, last, to,
                                    [](const HalfEdge& h, std::uint32_t v) { return h.to < v; });
  auto high = low;
  while (high != last && high->to == to) ++high;
  return {low, high};
}

// Join the two triangles of each edge. Of all crowded edges, names the earliest triangle that is
// one too many.
std::optional<MeshDefect> fill_neighbours(SurfaceMesh& mesh) {
  const std::vector<HalfEdge> half_edge = sorted_half_edges(mesh);
  mesh.neighbour.assign(mesh.triangle.size(),
                        {contact::kNoTriangle, contact::kNoTriangle, contact::kNoTriangle});
  std::optional<MeshDefect> worst;
  for (std::uint32_t from = 0; from < mesh.vertex_m.size(); ++from) {
    for (std::uint32_t i = mesh.fan_start[from]; i < mesh.fan_start[from + 1]; ++i) {
      const HalfEdge& here = half_edge[i];
      const std::span<const HalfEdge> back = run(mesh, half_edge, here.to, from);
      // The half edge of the neighbour runs the other way.
      if (!back.empty()) mesh.neighbour[here.id / 3][here.id % 3] = back[0].id / 3;
      // Sorted by their end: two alike in a row are two triangles on one side of an edge.
      if (i == mesh.fan_start[from] || half_edge[i - 1].to != here.to) continue;
      const std::uint32_t t = here.id / 3;
      if (worst && worst->triangle <= t) continue;
      const bool alone = back.empty() && run(mesh, half_edge, from, here.to).size() == 2;
      worst = MeshDefect{.flaw = alone ? MeshFlaw::kSameDirection : MeshFlaw::kCrowdedEdge,
                         .triangle = t,
                         .other = half_edge[i - 1].id / 3,
                         .from = from,
                         .to = here.to};
    }
  }
  return worst;
}

// n_v = sum over the fan of (corner angle) * (face normal), made unit.
void fill_normals(SurfaceMesh& mesh) {
  mesh.face_normal.resize(mesh.triangle.size());
  mesh.vertex_normal.assign(mesh.vertex_m.size(), Vec3{});
  for (std::size_t i = 0; i < mesh.triangle.size(); ++i) {
    const contact::TriangleCorners& t = mesh.triangle[i];
    const Vec3 doubled_m2 = doubled_area_m2(mesh.vertex_m, t);
    const double size_m2 = norm(doubled_m2);
    mesh.face_normal[i] = normalized(doubled_m2);
    for (std::size_t e = 0; e < 3; ++e) {
      const Vec3 a_m = mesh.vertex_m[t[(e + 1) % 3]] - mesh.vertex_m[t[e]];
      const Vec3 b_m = mesh.vertex_m[t[(e + 2) % 3]] - mesh.vertex_m[t[e]];
      // angle = atan2(|a x b|, a . b)
      mesh.vertex_normal[t[e]] += std::atan2(size_m2, dot(a_m, b_m)) * mesh.face_normal[i];
    }
  }
  for (std::size_t v = 0; v < mesh.vertex_m.size(); ++v) {
    Vec3& normal = mesh.vertex_normal[v];
    const bool lonely = mesh.fan_start[v] == mesh.fan_start[v + 1];
    // Sheets folded flat on each other cancel; any face of the fan is then as good as another.
    if (!(norm(normal) > 1e-9))
      normal = lonely ? Vec3{0.0, 0.0, 1.0} : mesh.face_normal[mesh.fan[mesh.fan_start[v]]];
    normal = normalized(normal);
  }
}

}  // namespace

const char* what(MeshFlaw flaw) {
  switch (flaw) {
    case MeshFlaw::kMissingVertex:
      return "names a vertex that does not exist";
    case MeshFlaw::kNotFinite:
      return "has a corner that is not finite";
    case MeshFlaw::kRepeatedCorner:
      return "has the same corner twice";
    case MeshFlaw::kZeroArea:
      return "has zero area";
    case MeshFlaw::kSameDirection:
      return "faces the other way than its neighbour";
    case MeshFlaw::kCrowdedEdge:
      return "is one too many on an edge that has two triangles already";
  }
  return "is unsound";
}

const char* remedy(MeshFlaw flaw) {
  switch (flaw) {
    case MeshFlaw::kMissingVertex:
    case MeshFlaw::kNotFinite:
      return "export the mesh again";
    case MeshFlaw::kRepeatedCorner:
    case MeshFlaw::kZeroArea:
      return "tact-mesh FILE --weld --drop-degenerate --out NEW.obj removes such faces";
    case MeshFlaw::kSameDirection:
      return "tact-mesh FILE --out NEW.obj turns faces as their neighbours";
    case MeshFlaw::kCrowdedEdge:
      return "tact-mesh FILE --weld --drop-degenerate --out NEW.obj removes or parts such faces";
  }
  return "export the mesh again";
}

void fill_records(SurfaceMesh& mesh) {
  std::vector<bool> on_boundary(mesh.vertex_m.size());
  for (std::size_t i = 0; i < mesh.triangle.size(); ++i)
    for (std::size_t e = 0; e < 3; ++e)
      if (mesh.neighbour[i][e] == contact::kNoTriangle)
        on_boundary[mesh.triangle[i][e]] = on_boundary[mesh.triangle[i][(e + 1) % 3]] = true;
  mesh.record.resize(mesh.triangle.size());
  for (std::size_t i = 0; i < mesh.triangle.size(); ++i) {
    contact::TriangleRecord& record = mesh.record[i];
    record.normal = mesh.face_normal[i];
    record.neighbour = mesh.neighbour[i];
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint32_t v = mesh.triangle[i][e];
      const std::uint32_t count = mesh.fan_start[v + 1] - mesh.fan_start[v];
      record.corner_m[e] = mesh.vertex_m[v];
      record.fan_start[e] = mesh.fan_start[v];
      // More than kMaxFan are refused for the organ (scene/tissue.cc); a tool's mesh is only drawn.
      record.fan_count[e] = static_cast<std::uint8_t>(std::min(count, contact::kMaxFan));
      record.on_boundary[e] = on_boundary[v];
    }
  }
}

void shift(SurfaceMesh& mesh, const Vec3& by_m) {
  for (Vec3& p : mesh.vertex_m) p += by_m;
  fill_records(mesh);
}

void scale(SurfaceMesh& mesh, double factor) {
  for (Vec3& p : mesh.vertex_m) p = p * factor;
  fill_records(mesh);
}

SurfaceOrDefect build_surface(std::vector<Vec3> vertex_m,
                              std::vector<contact::TriangleCorners> triangle) {
  for (std::uint32_t t = 0; t < triangle.size(); ++t) {
    const std::optional<MeshFlaw> flaw = corner_flaw(vertex_m, triangle[t]);
    if (flaw) return MeshDefect{.flaw = *flaw, .triangle = t};
  }
  SurfaceMesh mesh;
  mesh.vertex_m = std::move(vertex_m);
  mesh.triangle = std::move(triangle);
  fill_fans(mesh);
  if (const std::optional<MeshDefect> defect = fill_neighbours(mesh)) return *defect;
  fill_normals(mesh);
  fill_records(mesh);
  return mesh;
}

Result<SurfaceMesh> make_surface_mesh(std::vector<Vec3> vertex_m,
                                      std::vector<contact::TriangleCorners> triangle) {
  if (triangle.empty()) return Error{"the mesh has no triangles; give it at least one"};
  if (triangle.size() > kMaxTriangles || vertex_m.size() > 3 * kMaxTriangles) {
    return Error{
        fmt::format("the mesh has {} vertices and {} triangles, at most {} triangles fit; "
                    "simplify it",
                    vertex_m.size(), triangle.size(), kMaxTriangles)};
  }
  SurfaceOrDefect built = build_surface(std::move(vertex_m), std::move(triangle));
  if (auto* mesh = std::get_if<SurfaceMesh>(&built)) return std::move(*mesh);
  const MeshDefect& defect = *std::get_if<MeshDefect>(&built);
  return Error{
      fmt::format("triangle {} {}; {}", defect.triangle, what(defect.flaw), remedy(defect.flaw))};
}

MeshSummary summarize(const SurfaceMesh& mesh) {
  MeshSummary sum;
  sum.vertices = mesh.vertex_m.size();
  sum.triangles = mesh.triangle.size();
  if (mesh.vertex_m.empty()) return sum;
  const Vec3 base_m = mesh.vertex_m[0];  // near the mesh, so that large offsets do not cancel
  sum.low_m = sum.high_m = base_m;
  for (const Vec3& p : mesh.vertex_m) {
    sum.low_m = {std::min(sum.low_m.x, p.x), std::min(sum.low_m.y, p.y),
                 std::min(sum.low_m.z, p.z)};
    sum.high_m = {std::max(sum.high_m.x, p.x), std::max(sum.high_m.y, p.y),
                  std::max(sum.high_m.z, p.z)};
  }
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const Vec3 doubled_m2 = doubled_area_m2(mesh.vertex_m, mesh.triangle[t]);
    // A = |a x b| / 2,  V = sum (p . (a x b)) / 6
    sum.area_m2 += 0.5 * norm(doubled_m2);
    sum.volume_m3 += dot(mesh.vertex_m[mesh.triangle[t][0]] - base_m, doubled_m2) / 6.0;
    for (const std::uint32_t across : mesh.neighbour[t])
      sum.boundary_edges += across == contact::kNoTriangle;
  }
  return sum;
}

std::size_t count_parts(const SurfaceMesh& mesh) {
  std::vector<bool> seen(mesh.triangle.size());
  std::vector<std::uint32_t> left;
  std::size_t parts = 0;
  for (std::uint32_t first = 0; first < seen.size(); ++first) {
    if (seen[first]) continue;
    ++parts;
    seen[first] = true;
    left.assign(1, first);
    while (!left.empty()) {
      const std::uint32_t t = left.back();
      left.pop_back();
      for (const std::uint32_t next : mesh.neighbour[t]) {
        if (next == contact::kNoTriangle || seen[next]) continue;
        seen[next] = true;
        left.push_back(next);
      }
    }
  }
  return parts;
}

}  // namespace tact::model::mesh
