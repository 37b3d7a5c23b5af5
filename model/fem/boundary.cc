// SPDX-License-Identifier: Apache-2.0
#include "model/fem/boundary.h"

#include <algorithm>

namespace tact::model::fem {
namespace {

// Nodes of an element (tet_mesh.h), corners counter-clockwise seen from outside.
constexpr std::array<std::array<std::size_t, 6>, 4> kFaces{
    {{0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}}};

struct SortedFace {
  std::array<std::uint32_t, 3> key;  // corners, ascending
  FaceNodes nodes;
};

bool is_inside(const Vec3& p, const Vec3& low, const Vec3& high) {
  return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y &&
         p.z <= high.z;
}

}  // namespace

Boundary find_boundary(const TetMesh& mesh) {
  std::vector<SortedFace> all;
  all.reserve(4 * mesh.element.size());
  for (const TetNodes& e : mesh.element)
    for (const auto& local : kFaces) {
      SortedFace f{};
      for (std::size_t i = 0; i < 6; ++i) f.nodes[i] = e[local[i]];
      f.key = {f.nodes[0], f.nodes[1], f.nodes[2]};
      std::sort(f.key.begin(), f.key.end());
      all.push_back(f);
    }
  // Faces of two elements lie side by side then: what has no twin is skin.
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
  Boundary out;
  out.faces_of_node.resize(mesh.node_m.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool twin_before = i > 0 && all[i - 1].key == all[i].key;
    const bool twin_after = i + 1 < all.size() && all[i + 1].key == all[i].key;
    if (twin_before || twin_after) continue;
    const FaceNodes& f = all[i].nodes;
    for (const std::uint32_t node : f)
      out.faces_of_node[node].push_back(static_cast<std::uint32_t>(out.face.size()));
    const Vec3& o = mesh.node_m[f[0]];
    out.normal.push_back(normalized(cross(mesh.node_m[f[1]] - o, mesh.node_m[f[2]] - o)));
    out.face.push_back(f);
  }
  return out;
}

std::vector<std::uint32_t> nodes_of_faces_in_box(const TetMesh& mesh, const Boundary& boundary,
                                                 const Vec3& low_m, const Vec3& high_m) {
  std::vector<std::uint32_t> nodes;
  for (const FaceNodes& f : boundary.face) {
    const bool held = is_inside(mesh.node_m[f[0]], low_m, high_m) &&
                      is_inside(mesh.node_m[f[1]], low_m, high_m) &&
                      is_inside(mesh.node_m[f[2]], low_m, high_m);
    if (held) nodes.insert(nodes.end(), f.begin(), f.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

std::vector<std::uint32_t> skin_nodes(const Boundary& boundary) {
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t i = 0; i < boundary.faces_of_node.size(); ++i)
    if (!boundary.faces_of_node[i].empty()) nodes.push_back(i);
  return nodes;
}

}  // namespace tact::model::fem
