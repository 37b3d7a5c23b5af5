// SPDX-License-Identifier: Apache-2.0
// patch_region.h - the part of a patch surface that is stepped now: gathered around the touched
// triangles, ring by ring, up to a fixed number of vertices.
//
// Vertices outside stay at rest. A vertex with a neighbour outside is the rim and stays there too,
// so every vertex that moves has all its springs. A vertex that leaves the region returns to rest,
// except on the edges of a cut, which keep the displacement that they had. The energy that a return
// adds is taken from the kinetic energy of those that stay. What that cannot cover is kept as
// energy_deficit_J; it is small, since hardly anything moves at the rim. With relaxation
// (patch_memory.h) a vertex that leaves also forgets how it was stretched, cut edges too.
//
// Gathering costs the region, not the mesh. Cuts are marks on edges; the list of cut triangles and
// of cut edges has a fixed capacity, and a blade that finds it full cuts no more.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "model/contact/blade.h"
#include "model/springs/patch_memory.h"
#include "model/springs/patch_surface.h"
#include "model/springs/spring_network.h"

namespace tact::model::springs {

inline constexpr std::size_t kMaxPatchNodes = 1024;
inline constexpr std::size_t kMaxCutTriangles = 1024;
inline constexpr std::uint32_t kNoSlot = 0xFFFFFFFFu;

class PatchRegion {
 public:
  /// Memory is taken here. nodes: 4 .. kMaxPatchNodes.
  PatchRegion(PatchSurface surface, double node_mass_kg, std::size_t nodes,
              const law::Relaxation& relaxation = {});

  /// Around these triangles, nearest first.
  void gather(std::span<const std::uint32_t> triangles) RT_SAFE;
  /// Is the triangle in the region and well away from its rim?
  bool holds(std::uint32_t triangle) const RT_SAFE;
  /// Everything at rest, nothing stepped; cuts remain.
  void rest() RT_SAFE;
  /// Removes the springs that the blade passes through; returns how many.
  std::size_t cut(const contact::BladeSweep& sweep) RT_SAFE;

  /// What is stepped; with relaxation its positions are what the springs feel, and flow() after
  /// the last step of a tick sets the positions of the vertices.
  SpringNetwork network(std::span<const ProbeSpring> probes) RT_SAFE;
  void flow() RT_SAFE { memory_.flow({position_m_.data(), count_}, {rest_m_.data(), count_}); }
  bool relaxes() const RT_SAFE { return memory_.is_on(); }
  /// How far a vertex of the region is from the position that its springs use.
  Vec3 flowed_m(std::uint32_t slot) const RT_SAFE {
    return memory_.flowed_m(slot, position_m_[slot]);
  }
  /// Springs, anchors and loads, shared out over the terms of the relaxation.
  double stored_energy_J() RT_SAFE;
  /// Energy of the springs in the region, as if none were cut, with all vertices at rest.
  double rest_energy_J() const RT_SAFE { return rest_energy_J_; }
  double energy_deficit_J() const RT_SAFE { return energy_deficit_J_; }

  const PatchSurface& surface() const RT_SAFE { return surface_; }
  std::size_t capacity() const RT_SAFE { return position_m_.size(); }
  /// Nearest to the contact first.
  std::span<const std::uint32_t> vertices() const RT_SAFE { return {vertex_.data(), count_}; }
  std::uint32_t slot_of(std::uint32_t vertex) const RT_SAFE { return slot_of_[vertex]; }
  Vec3 moved_m(std::uint32_t vertex) const RT_SAFE;
  std::size_t spring_count() const RT_SAFE { return springs_; }
  std::size_t spring_capacity() const RT_SAFE { return spring_.size(); }
  /// In the order of the cut.
  std::span<const std::uint32_t> cut_triangles() const RT_SAFE {
    return {cut_triangle_.data(), cut_triangles_};
  }
  std::span<const std::uint32_t> cut_edges() const RT_SAFE {
    return {cut_edge_.data(), cut_edges_};
  }
  bool is_cut_edge(std::uint32_t vertex) const RT_SAFE { return is_cut_edge_[vertex] != 0; }
  std::size_t memory_bytes() const;

 private:
  void choose(std::span<const std::uint32_t> triangles) RT_SAFE;
  void add(std::uint32_t vertex, std::uint32_t ring) RT_SAFE;
  void connect() RT_SAFE;
  double free_energy_J() RT_SAFE;
  void take_from_velocities(double energy_J) RT_SAFE;
  bool open(std::uint32_t edge) RT_SAFE;

  PatchSurface surface_;
  double inverse_mass_per_kg_;
  PatchMemory memory_;
  // of the region, by slot; old_ is the state before gathering
  std::vector<std::uint32_t> vertex_, old_vertex_, ring_;
  std::vector<Vec3> position_m_, velocity_mps_, old_position_m_, old_velocity_mps_, rest_m_,
      load_N_;
  std::vector<double> node_inverse_mass_per_kg_, anchor_N_per_m_, drag_Ns_per_m_;
  std::vector<Spring> spring_;
  std::vector<std::uint32_t> spring_edge_;
  std::size_t count_ = 0, springs_ = 0;
  double rest_energy_J_ = 0.0, cut_energy_J_ = 0.0, energy_deficit_J_ = 0.0;
  // of the whole mesh
  std::vector<std::uint32_t> slot_of_;
  std::vector<std::array<float, 3>> kept_m_;
  std::vector<std::uint8_t> is_cut_edge_, edge_is_cut_, triangle_is_cut_;
  std::vector<std::uint32_t> cut_triangle_, cut_edge_;
  std::size_t cut_triangles_ = 0, cut_edges_ = 0;
};

}  // namespace tact::model::springs
