// SPDX-License-Identifier: Apache-2.0
#include "model/springs/patch_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/contact/contact_law.h"

namespace tact::model::springs {
namespace {

/// Every edge once: from the triangle that knows it first.
std::vector<PatchEdge> edges_of(const contact::SurfaceView& mesh) {
  std::vector<PatchEdge> edges;
  for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t) {
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint32_t other = mesh.neighbour[t][e];
      // The lower triangle has reported it.
      if (other != contact::kNoTriangle && other < t) continue;
      const auto [a, b] = std::minmax(mesh.triangle[t][e], mesh.triangle[t][(e + 1) % 3]);
      edges.push_back({.a = a,
                       .b = b,
                       .triangle = {t, other},
                       .length_m = norm(mesh.vertex_m[b] - mesh.vertex_m[a])});
    }
  }
  return edges;
}

void index_edges(PatchSurface& surface) {
  surface.edge_start.assign(surface.mesh.vertex_m.size() + 1, 0);
  for (const PatchEdge& e : surface.edge)
    ++surface.edge_start[e.a + 1], ++surface.edge_start[e.b + 1];
  for (std::size_t v = 1; v < surface.edge_start.size(); ++v)
    surface.edge_start[v] += surface.edge_start[v - 1];
  surface.edge_of.resize(2 * surface.edge.size());
  std::vector<std::uint32_t> next(surface.edge_start.begin(), surface.edge_start.end() - 1);
  for (std::uint32_t i = 0; i < surface.edge.size(); ++i)
    for (const std::uint32_t v : {surface.edge[i].a, surface.edge[i].b})
      surface.edge_of[next[v]++] = i;
}

// Short waves of a net are softer than long ones: what that adds to the compliance, within 6 % for
// anchors of k / 40 to 2 k.
constexpr double kShortWaves = 1.2;

/// Over all waves of one vertex of a net with this modulus.
double compliance_m_per_N(double modulus_N_per_m, double anchor_N_per_m) {
  const double all_waves = 4.0 * std::numbers::pi * modulus_N_per_m;
  return kShortWaves * std::log1p(all_waves / anchor_N_per_m) / all_waves;
}

/// k_x of MA-21: what a spring under pretension resists across itself.
double across_N_per_m(const PatchTissue& tissue) {
  return tissue.surface_stiffness_N_per_m * tissue.pretension_ratio /
         (1.0 + tissue.pretension_ratio);
}

}  // namespace

std::size_t PatchSurface::memory_bytes() const {
  return edge.size() * sizeof(PatchEdge) +
         (edge_start.size() + edge_of.size()) * sizeof(std::uint32_t) +
         anchor_N_per_m.size() * (2 * sizeof(double) + sizeof(Vec3));
}

std::optional<std::uint32_t> crowded_vertex(const contact::SurfaceView& mesh) {
  for (std::uint32_t v = 0; v < mesh.vertex_m.size(); ++v)
    if (mesh.fan_start[v + 1] - mesh.fan_start[v] >= kMaxPatchDegree) return v;
  return std::nullopt;
}

// MA-21. kLattice: moduli of a net of equal triangles.
double sideways_compliance_m_per_N(const PatchTissue& tissue, double anchor_N_per_m) {
  constexpr double kLattice = 0.25 * std::numbers::sqrt3;
  const double k = tissue.surface_stiffness_N_per_m, across = across_N_per_m(tissue);
  return 0.5 * (compliance_m_per_N(kLattice * (3.0 * k + across), anchor_N_per_m) +
                compliance_m_per_N(kLattice * (k + 3.0 * across), anchor_N_per_m));
}

PatchSurface make_patch_surface(const contact::SurfaceView& mesh, const PatchTissue& tissue) {
  PatchSurface out{.mesh = mesh, .edge = edges_of(mesh), .tissue = tissue};
  index_edges(out);
  const std::size_t n = mesh.vertex_m.size();
  double sum_m2 = 0.0;
  out.anchor_N_per_m.assign(n, 0.0);
  for (const auto& [a, b, c] : mesh.triangle) {
    const double area_m2 =
        0.5 * norm(cross(mesh.vertex_m[b] - mesh.vertex_m[a], mesh.vertex_m[c] - mesh.vertex_m[a]));
    // For now it gathers area; per_m2 below makes it stiffness.
    for (const std::uint32_t v : {a, b, c}) out.anchor_N_per_m[v] += area_m2;
    sum_m2 += 3.0 * area_m2;
  }
  // a = a_mean A_i / A_mean
  const double per_m2 = static_cast<double>(n) / sum_m2;
  for (std::size_t v = 0; v < n; ++v)
    out.anchor_N_per_m[v] *= per_m2 * tissue.body_stiffness_N_per_m;
  out.sideways_m_per_N.reserve(n);
  for (const double anchor : out.anchor_N_per_m)
    out.sideways_m_per_N.push_back(sideways_compliance_m_per_N(tissue, anchor));
  out.load_N.assign(n, Vec3{});
  for (const PatchEdge& e : out.edge) {
    const double tension_N = tissue.surface_stiffness_N_per_m * (e.length_m - out.rest_length_m(e));
    const Vec3 pull_N = (tension_N / e.length_m) * (mesh.vertex_m[e.b] - mesh.vertex_m[e.a]);
    // Against the pull of the edge: at rest the sum is zero, and only a cut sets it free.
    out.load_N[e.a] -= pull_N;
    out.load_N[e.b] += pull_N;
  }
  return out;
}

}  // namespace tact::model::springs
