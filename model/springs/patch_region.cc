// SPDX-License-Identifier: Apache-2.0
#include "model/springs/patch_region.h"

#include <cmath>
#include <utility>

namespace tact::model::springs {
namespace {

// Euler: a closed surface of n vertices has 3 n - 6 edges, and 6 more for each handle.
constexpr std::size_t kSpringsPerNode = 4;

}  // namespace

PatchRegion::PatchRegion(PatchSurface surface, double node_mass_kg, std::size_t nodes,
                         const law::Relaxation& relaxation)
    : surface_(std::move(surface)),
      inverse_mass_per_kg_(1.0 / node_mass_kg),
      memory_(relaxation, nodes) {
  for (auto* ids : {&vertex_, &old_vertex_, &ring_}) ids->resize(nodes);
  for (auto* v :
       {&position_m_, &velocity_mps_, &old_position_m_, &old_velocity_mps_, &rest_m_, &load_N_})
    v->resize(nodes);
  for (auto* v : {&node_inverse_mass_per_kg_, &anchor_N_per_m_, &drag_Ns_per_m_}) v->resize(nodes);
  spring_.resize(kSpringsPerNode * nodes);
  spring_edge_.resize(spring_.size());
  const std::size_t n = surface_.mesh.vertex_m.size();
  slot_of_.assign(n, kNoSlot);
  kept_m_.assign(n, {});
  is_cut_edge_.assign(n, 0);
  edge_is_cut_.assign(surface_.edge.size(), 0);
  triangle_is_cut_.assign(surface_.mesh.triangle.size(), 0);
  cut_triangle_.resize(kMaxCutTriangles);
  // Each cut triangle has three corners.
  cut_edge_.resize(3 * kMaxCutTriangles);
}

std::size_t PatchRegion::memory_bytes() const {
  const std::size_t n = slot_of_.size();
  return surface_.memory_bytes() + memory_.memory_bytes() +
         capacity() * (3 * sizeof(std::uint32_t) + 6 * sizeof(Vec3) + 3 * sizeof(double)) +
         spring_.size() * (sizeof(Spring) + sizeof(std::uint32_t)) +
         n * (sizeof(std::uint32_t) + 3 * sizeof(float) + 1) + edge_is_cut_.size() +
         triangle_is_cut_.size() + 4 * kMaxCutTriangles * sizeof(std::uint32_t);
}

SpringNetwork PatchRegion::network(std::span<const ProbeSpring> probes) RT_SAFE {
  const std::size_t n = count_;
  return {.node = {.position_m =
                       relaxes() ? memory_.relaxed_rest_m(n) : std::span(position_m_.data(), n),
                   .velocity_mps = {velocity_mps_.data(), n},
                   .rest_m = {rest_m_.data(), n},
                   .load_N = {load_N_.data(), n},
                   .inverse_mass_per_kg = {node_inverse_mass_per_kg_.data(), n},
                   .anchor_N_per_m = {anchor_N_per_m_.data(), n},
                   .drag_Ns_per_m = {drag_Ns_per_m_.data(), n}},
          .spring = {spring_.data(), springs_},
          .probe = probes};
}

Vec3 PatchRegion::moved_m(std::uint32_t vertex) const RT_SAFE {
  const std::uint32_t slot = slot_of_[vertex];
  if (slot != kNoSlot) return position_m_[slot] - rest_m_[slot];
  const auto& kept = kept_m_[vertex];
  return {static_cast<double>(kept[0]), static_cast<double>(kept[1]), static_cast<double>(kept[2])};
}

bool PatchRegion::holds(std::uint32_t triangle) const RT_SAFE {
  if (count_ == 0) return false;
  const std::uint32_t outermost = ring_[count_ - 1];
  for (const std::uint32_t v : surface_.mesh.triangle[triangle]) {
    const std::uint32_t slot = slot_of_[v];
    // The inner quarter of the rings: a tool that slides needs a new region once in many ticks.
    if (slot == kNoSlot || node_inverse_mass_per_kg_[slot] == 0.0 || 4 * ring_[slot] > outermost)
      return false;
  }
  return true;
}

void PatchRegion::rest() RT_SAFE {
  for (std::size_t i = 0; i < count_; ++i) slot_of_[vertex_[i]] = kNoSlot;
  for (std::size_t i = 0; i < cut_edges_; ++i) kept_m_[cut_edge_[i]] = {};
  count_ = springs_ = 0;
  rest_energy_J_ = cut_energy_J_ = energy_deficit_J_ = 0.0;
}

// Ring by ring over the edges of the mesh, cut or not. The list of vertices is its own queue.
void PatchRegion::choose(std::span<const std::uint32_t> triangles) RT_SAFE {
  count_ = 0;
  for (const std::uint32_t t : triangles)
    for (const std::uint32_t v : surface_.mesh.triangle[t]) add(v, 0);
  for (std::size_t i = 0; i < count_ && count_ < capacity(); ++i) {
    for (const std::uint32_t e : surface_.edges_at(vertex_[i])) {
      const PatchEdge& edge = surface_.edge[e];
      add(edge.a == vertex_[i] ? edge.b : edge.a, ring_[i] + 1);
    }
  }
}

void PatchRegion::add(std::uint32_t vertex, std::uint32_t ring) RT_SAFE {
  if (count_ == capacity() || slot_of_[vertex] != kNoSlot) return;
  slot_of_[vertex] = static_cast<std::uint32_t>(count_);
  vertex_[count_] = vertex;
  ring_[count_] = ring;
  ++count_;
}

void PatchRegion::gather(std::span<const std::uint32_t> triangles) RT_SAFE {
  // In this order: energy, while the old region exists; cut edges, before their slots are gone; the
  // new region at rest; what stays from the old one; springs; and only then what all that has
  // added.
  const double before_J = free_energy_J();
  std::swap(vertex_, old_vertex_);
  std::swap(position_m_, old_position_m_);
  std::swap(velocity_mps_, old_velocity_mps_);
  memory_.set_aside();
  const std::size_t old_count = count_;
  for (std::size_t i = 0; i < old_count; ++i) {
    const std::uint32_t v = old_vertex_[i];
    const Vec3 moved_m = old_position_m_[i] - surface_.mesh.vertex_m[v];
    if (is_cut_edge_[v] != 0)
      kept_m_[v] = {static_cast<float>(moved_m.x), static_cast<float>(moved_m.y),
                    static_cast<float>(moved_m.z)};
    slot_of_[v] = kNoSlot;
  }
  choose(triangles);
  for (std::size_t i = 0; i < count_; ++i) {
    const std::uint32_t v = vertex_[i];
    const auto& kept = kept_m_[v];
    rest_m_[i] = surface_.mesh.vertex_m[v];
    position_m_[i] = rest_m_[i] + Vec3{static_cast<double>(kept[0]), static_cast<double>(kept[1]),
                                       static_cast<double>(kept[2])};
    velocity_mps_[i] = {};
    load_N_[i] = surface_.load_N[v];
    anchor_N_per_m_[i] = surface_.anchor_N_per_m[v];
    drag_Ns_per_m_[i] = surface_.tissue.body_damping_time_s * anchor_N_per_m_[i];
    node_inverse_mass_per_kg_[i] = inverse_mass_per_kg_;
    memory_.forget(i, rest_m_[i]);
  }
  for (std::size_t i = 0; i < old_count; ++i) {
    const std::uint32_t slot = slot_of_[old_vertex_[i]];
    if (slot == kNoSlot) continue;
    position_m_[slot] = old_position_m_[i];
    velocity_mps_[slot] = old_velocity_mps_[i];
    memory_.keep(slot, i);
  }
  connect();
  memory_.renew(network({}), {position_m_.data(), count_});
  take_from_velocities(free_energy_J() - before_J);
}

// Finds the springs between the chosen vertices and puts the rim to rest.
void PatchRegion::connect() RT_SAFE {
  const PatchTissue& tissue = surface_.tissue;
  const double k = tissue.surface_stiffness_N_per_m;
  springs_ = 0;
  rest_energy_J_ = cut_energy_J_ = 0.0;
  for (std::uint32_t i = 0; i < count_; ++i) {
    for (const std::uint32_t e : surface_.edges_at(vertex_[i])) {
      const PatchEdge& edge = surface_.edge[e];
      const std::uint32_t j = slot_of_[edge.a == vertex_[i] ? edge.b : edge.a];
      // A neighbour outside makes it the rim: with a spring missing it must not move.
      if (j == kNoSlot) node_inverse_mass_per_kg_[i] = 0.0;
      // Each spring once, from its lower end.
      if (j == kNoSlot || j < i || springs_ == spring_.size()) continue;
      const double length_m = surface_.rest_length_m(edge);
      const double stretch_m = edge.length_m - length_m;
      rest_energy_J_ += 0.5 * k * stretch_m * stretch_m;
      if (edge_is_cut_[e] != 0) {
        cut_energy_J_ += 0.5 * k * stretch_m * stretch_m;
        continue;
      }
      spring_[springs_] = {.i = i,
                           .j = j,
                           .stiffness_N_per_m = k,
                           .damping_Ns_per_m = tissue.damping_time_s * k,
                           .rest_length_m = length_m};
      spring_edge_[springs_++] = e;
    }
    if (node_inverse_mass_per_kg_[i] > 0.0) continue;
    velocity_mps_[i] = {};
    if (is_cut_edge_[vertex_[i]] != 0) continue;
    position_m_[i] = rest_m_[i];
    memory_.forget(i, rest_m_[i]);
  }
}

// Stored and moving, above the same springs at rest.
double PatchRegion::free_energy_J() RT_SAFE {
  return stored_energy_J() - (rest_energy_J_ - cut_energy_J_) + kinetic_energy_J(network({}));
}

double PatchRegion::stored_energy_J() RT_SAFE {
  const SpringNetwork now = network({});
  return relaxes() ? memory_.stored_energy_J(now, {position_m_.data(), count_})
                   : model::springs::stored_energy_J(now);
}

void PatchRegion::take_from_velocities(double energy_J) RT_SAFE {
  if (!(energy_J > 0.0)) return;
  const double moving_J = kinetic_energy_J(network({}));
  // Speeds scale as the root of energy; what is not there is the deficit.
  const double left = moving_J > energy_J ? std::sqrt(1.0 - energy_J / moving_J) : 0.0;
  for (std::size_t i = 0; i < count_; ++i) velocity_mps_[i] *= left;
  if (energy_J > moving_J) energy_deficit_J_ += energy_J - moving_J;
}

std::size_t PatchRegion::cut(const contact::BladeSweep& sweep) RT_SAFE {
  const contact::SweepBox box = box_around(sweep);
  std::size_t cuts = 0;
  for (std::size_t k = 0; k < springs_;) {
    const Spring& s = spring_[k];
    const Vec3 &p_m = position_m_[s.i], &q_m = position_m_[s.j];
    if (misses(box, p_m, q_m) || !crosses(sweep, p_m, q_m) || !open(spring_edge_[k])) {
      ++k;
      continue;
    }
    const PatchEdge& edge = surface_.edge[spring_edge_[k]];
    const double stretch_m = edge.length_m - s.rest_length_m;
    cut_energy_J_ += 0.5 * s.stiffness_N_per_m * stretch_m * stretch_m;
    --springs_;
    // The last one takes its place, so k is looked at again.
    spring_[k] = spring_[springs_];
    spring_edge_[k] = spring_edge_[springs_];
    ++cuts;
  }
  // c has changed: what was cut held pretension.
  if (cuts > 0) memory_.renew(network({}), {position_m_.data(), count_});
  return cuts;
}

// Marks an edge as cut, with its triangles and their corners; false if the list is full.
bool PatchRegion::open(std::uint32_t edge) RT_SAFE {
  const auto& sides = surface_.edge[edge].triangle;
  std::size_t fresh = 0;
  for (const std::uint32_t t : sides)
    if (t != contact::kNoTriangle && triangle_is_cut_[t] == 0) ++fresh;
  if (cut_triangles_ + fresh > kMaxCutTriangles) return false;
  edge_is_cut_[edge] = 1;
  for (const std::uint32_t t : sides) {
    if (t == contact::kNoTriangle || triangle_is_cut_[t] != 0) continue;
    triangle_is_cut_[t] = 1;
    cut_triangle_[cut_triangles_++] = t;
    for (const std::uint32_t v : surface_.mesh.triangle[t]) {
      if (is_cut_edge_[v] != 0) continue;
      is_cut_edge_[v] = 1;
      cut_edge_[cut_edges_++] = v;
    }
  }
  return true;
}

}  // namespace tact::model::springs
