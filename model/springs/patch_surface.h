// SPDX-License-Identifier: Apache-2.0
// patch_surface.h - an organ's surface as springs: what a spring patch (spring_patch.h) walks over.
//
//     edges         spring k, c = tau k,  L0 = L / (1 + p)          L: length at rest
//     vertices      anchor a = a_mean A_i / A_mean, drag = tau_b a   A: area around the vertex
//                   load = - sum of the edges' pull at rest          so that rest is equilibrium
//
//     sideways      MA-21 for the anchor of each vertex             a tool that drags it
//
// p is the pretension: a cut edge no longer pulls its ends together, and the loads open the cut.
// Built once for the whole mesh; the loop changes the cut marks alone.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "model/contact/surface.h"

namespace tact::model::springs {

inline constexpr std::uint32_t kMaxPatchDegree = 128;  // edges at one vertex

struct PatchEdge {
  std::uint32_t a = 0, b = 0;  // vertices, a < b
  std::array<std::uint32_t, 2> triangle{contact::kNoTriangle,
                                        contact::kNoTriangle};  // on its sides
  double length_m = 0.0;                                        // L
};

/// What the springs of a whole surface are made of.
struct PatchTissue {
  double surface_stiffness_N_per_m = 0.0;  // k, of an edge
  double body_stiffness_N_per_m = 0.0;     // a_mean, of a vertex of mean area
  double damping_time_s = 0.0;             // tau
  double body_damping_time_s = 0.0;        // tau_b
  double pretension_ratio = 0.0;           // p
};

struct PatchSurface {
  contact::SurfaceView mesh{};
  std::vector<PatchEdge> edge{};
  std::vector<std::uint32_t> edge_start{};  // vertices + 1, into edge_of
  std::vector<std::uint32_t> edge_of{};     // the edges of each vertex
  std::vector<double> anchor_N_per_m{};     // vertices
  std::vector<Vec3> load_N{};               // vertices
  std::vector<double> sideways_m_per_N{};   // vertices
  PatchTissue tissue{};

  std::span<const std::uint32_t> edges_at(std::uint32_t vertex) const RT_SAFE {
    return {edge_of.data() + edge_start[vertex], edge_start[vertex + 1] - edge_start[vertex]};
  }
  double rest_length_m(const PatchEdge& e) const RT_SAFE {
    return e.length_m / (1.0 + tissue.pretension_ratio);
  }
  std::size_t memory_bytes() const;
};

/// MA-21: how far a unit force along the surface moves its vertex, with all others free.
double sideways_compliance_m_per_N(const PatchTissue& tissue, double anchor_N_per_m);

/// The mesh outlives the surface. Of a vertex with too many edges, its number.
std::optional<std::uint32_t> crowded_vertex(const contact::SurfaceView& mesh);
PatchSurface make_patch_surface(const contact::SurfaceView& mesh, const PatchTissue& tissue);

}  // namespace tact::model::springs
