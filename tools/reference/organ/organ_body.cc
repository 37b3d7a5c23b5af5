// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/organ/organ_body.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "tools/ground_truth/ring_means.h"

namespace tact::tools::reference {
namespace {

using model::Vec3;
using model::fem::edge_key;
using model::fem::kTetEdge;

/// Middle node of every element edge.
std::unordered_map<std::uint64_t, std::uint32_t> middles_of(const model::fem::TetMesh& mesh) {
  std::unordered_map<std::uint64_t, std::uint32_t> out;
  for (const auto& e : mesh.element)
    for (std::size_t k = 0; k < kTetEdge.size(); ++k)
      out[edge_key(e[kTetEdge[k][0]], e[kTetEdge[k][1]])] = e[4 + k];
  return out;
}

}  // namespace

model::Result<OrganBody> make_organ_body(const model::mesh::SurfaceMesh& surface,
                                         const ground_truth::EdgeLengths& lengths,
                                         const mesh::HeldBox& held,
                                         const std::optional<Circle>& circle) {
  ground_truth::EdgeLengths on_surface = lengths;
  // It is for the inside: the skin is refined near the site alone.
  on_surface.largest_m = 0.0;
  auto refined = refine_surface({surface.vertex_m, surface.triangle}, on_surface);
  if (!refined) return refined.error();
  Triangles fine = std::move(*refined);
  // Edges along the rim: there the stress ends, or is singular.
  if (circle) fine = cut_along(std::move(fine), *circle, 2.0 * circle->radius_m);
  auto mesh = fill_with_gmsh(fine.vertex_m, fine.triangle, lengths);
  if (!mesh) return mesh.error();
  OrganBody body{.mesh = std::move(*mesh), .face = {}, .normal = {}, .held_node = {}};
  const auto middle = middles_of(body.mesh);
  for (const auto& t : fine.triangle) {
    FaceNodes nodes{t[0], t[1], t[2], 0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto found = middle.find(edge_key(t[k], t[(k + 1) % 3]));
      // Every triangle of the skin has to be a face of an element, or its six nodes are not known.
      if (found == middle.end())
        return model::Error{"gmsh changed the surface; ask tact-mesh whether it crosses itself"};
      nodes[3 + k] = found->second;
    }
    body.face.push_back(nodes);
    const Vec3 &a = fine.vertex_m[t[0]], &b = fine.vertex_m[t[1]], &c = fine.vertex_m[t[2]];
    body.normal.push_back(normalized(cross(b - a, c - a)));
  }
  // All corners of a small triangle are in the box if those of its big one are; the reverse is
  // not so, and a finer triangle may be held where its parent is not: the box is meant well away
  // from the site.
  body.held_node = nodes_of_faces(body, [&](std::size_t f) {
    const FaceNodes& n = body.face[f];
    return std::all_of(n.begin(), n.begin() + 3,
                       [&](std::uint32_t i) { return held.holds(body.mesh.node_m[i]); });
  });
  if (!body.held_node.empty()) return body;
  return model::Error{
      "no triangle of the organ lies in the held box, so it would fly away; move "
      "elastic.fixed_min_m "
      "and elastic.fixed_max_m (tact-mesh --align proposes them)"};
}

std::vector<std::uint32_t> nodes_of_faces(const OrganBody& body,
                                          const std::function<bool(std::size_t)>& wanted) {
  std::vector<std::uint32_t> out;
  for (std::size_t f = 0; f < body.face.size(); ++f)
    if (wanted(f)) out.insert(out.end(), body.face[f].begin(), body.face[f].end());
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::function<bool(std::size_t)> faces_within(const OrganBody& body, const Circle& circle) {
  return [&body, circle](std::size_t f) {
    const Vec3 c = centre_m(body, f);
    return circle.away_m(c) <= circle.radius_m &&
           std::abs(dot(c - circle.at_m, circle.axis)) < 2.0 * circle.radius_m &&
           dot(body.normal[f], circle.axis) < -ground_truth::kFacing;
  };
}

double area_m2(const OrganBody& body, const std::function<bool(std::size_t)>& wanted) {
  double sum_m2 = 0.0;
  for (std::size_t f = 0; f < body.face.size(); ++f) {
    if (!wanted(f)) continue;
    const FaceNodes& n = body.face[f];
    const Vec3& o = body.mesh.node_m[n[0]];
    sum_m2 += 0.5 * norm(cross(body.mesh.node_m[n[1]] - o, body.mesh.node_m[n[2]] - o));
  }
  return sum_m2;
}

Vec3 centre_m(const OrganBody& body, std::size_t face) {
  const FaceNodes& n = body.face[face];
  return (body.mesh.node_m[n[0]] + body.mesh.node_m[n[1]] + body.mesh.node_m[n[2]]) / 3.0;
}

}  // namespace tact::tools::reference
