// SPDX-License-Identifier: Apache-2.0
// patch_memory.h - relaxation of a spring patch: the node positions that its springs use.
//
//     z = g_0 u + sum of g_i e_i           springs and anchors act at X + z (shares: relaxation.h)
//     a tick   e_i += du,  z += du         the step of an integrator: elastic, nothing flows
//              e_i <- a_i e_i              then each term flows for the tick with u held: exact
//     W = g_0 U(u) + sum of g_i U(e_i) - c.(u - z)
//
//     u  displacement, m   e_i  stretch of term i, m   X  rest, m   a_i  exp(-dt / tau_i)
//     U  energy of springs, anchors and loads, J   c  net force at rest, N: what springs under
//     pretension held before they were cut; it is no stretch and does not fade
//
// For small stretches U is quadratic and the force is the slope of W while nothing flows; the flow
// then takes sum of g_i (1 - a_i^2) (U(e_i) + c.e_i), never below 0: passive at any tick. Damping
// and the tool's virtual spring belong to u alone. One evaluation of forces for all terms.
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "model/law/relaxation.h"
#include "model/springs/spring_network.h"

namespace tact::model::springs {

class PatchMemory {
 public:
  /// Memory is taken here; without terms there is none, and nothing is done.
  PatchMemory(const law::Relaxation& relaxation, std::size_t nodes);

  bool is_on() const RT_SAFE { return relaxation_.terms() > 0; }
  /// X + z of the first n nodes: what is stepped.
  std::span<Vec3> relaxed_rest_m(std::size_t n) RT_SAFE { return {relaxed_rest_m_.data(), n}; }
  /// u - z of a node.
  Vec3 flowed_m(std::size_t node, const Vec3& position_m) const RT_SAFE;

  /// Before nodes are gathered again: each is then kept from its old place, or forgotten.
  void set_aside() RT_SAFE { std::swap(stretched_, old_stretched_); }
  void keep(std::size_t node, std::size_t old_node) RT_SAFE;
  void forget(std::size_t node, const Vec3& rest_m) RT_SAFE;
  /// After nodes or springs have changed: z and c of a network that is stepped at felt_m.
  void renew(const SpringNetwork& network, std::span<const Vec3> position_m) RT_SAFE;
  /// The end of a tick: nodes follow what was stepped, then every term flows.
  void flow(std::span<Vec3> position_m, std::span<const Vec3> rest_m) RT_SAFE;

  /// W, J, of such a network; probes are not counted.
  double stored_energy_J(const SpringNetwork& network, std::span<Vec3> position_m) RT_SAFE;
  std::size_t memory_bytes() const;

 private:
  using Terms = std::array<std::vector<Vec3>, law::kMaxPronyTerms>;

  Vec3 blend_m(std::size_t node, const Vec3& position_m, const Vec3& rest_m) const RT_SAFE;

  law::Relaxation relaxation_;
  std::array<double, law::kMaxPronyTerms> fade_{};            // a_i
  Terms stretched_, old_stretched_;                           // X + e_i
  std::vector<Vec3> relaxed_rest_m_, still_mps_, opening_N_;  // X + z, zero velocities, c
};

}  // namespace tact::model::springs
