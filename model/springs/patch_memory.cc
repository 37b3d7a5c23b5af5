// SPDX-License-Identifier: Apache-2.0
#include "model/springs/patch_memory.h"

namespace tact::model::springs {

PatchMemory::PatchMemory(const law::Relaxation& relaxation, std::size_t nodes)
    : relaxation_(relaxation) {
  if (!is_on()) return;
  law::RelaxationState stretched;
  // A stretch of 1 after one tick without motion is a_i =
  // exp(-dt / tau_i) of each term (RX-3, q = 1).
  stretched.stretch_m.fill(1.0);
  fade_ = relaxation.after(stretched, 0.0, true).stretch_m;
  for (std::size_t i = 0; i < relaxation.terms(); ++i)
    for (Terms* terms : {&stretched_, &old_stretched_}) (*terms)[i].resize(nodes);
  for (auto* v : {&relaxed_rest_m_, &still_mps_, &opening_N_}) v->resize(nodes);
}

std::size_t PatchMemory::memory_bytes() const {
  return relaxed_rest_m_.size() * (3 + 2 * relaxation_.terms()) * sizeof(Vec3);
}

Vec3 PatchMemory::flowed_m(std::size_t node, const Vec3& position_m) const RT_SAFE {
  return is_on() ? position_m - relaxed_rest_m_[node] : Vec3{};
}

void PatchMemory::keep(std::size_t node, std::size_t old_node) RT_SAFE {
  for (std::size_t i = 0; i < relaxation_.terms(); ++i)
    stretched_[i][node] = old_stretched_[i][old_node];
}

void PatchMemory::forget(std::size_t node, const Vec3& rest_m) RT_SAFE {
  for (std::size_t i = 0; i < relaxation_.terms(); ++i) stretched_[i][node] = rest_m;
}

// X + z. Displacements are blended, so that a node at rest has exactly that.
Vec3 PatchMemory::blend_m(std::size_t node, const Vec3& position_m,
                          const Vec3& rest_m) const RT_SAFE {
  Vec3 z = relaxation_.share(0) * (position_m - rest_m);
  for (std::size_t i = 0; i < relaxation_.terms(); ++i)
    z += relaxation_.share(i + 1) * (stretched_[i][node] - rest_m);
  return rest_m + z;
}

void PatchMemory::renew(const SpringNetwork& network, std::span<const Vec3> position_m) RT_SAFE {
  if (!is_on()) return;
  const std::size_t n = position_m.size();
  const std::span<const Vec3> rest_m = network.node.rest_m;
  for (std::size_t i = 0; i < n; ++i) relaxed_rest_m_[i] = blend_m(i, position_m[i], rest_m[i]);
  // c: what springs and loads leave over at rest. The tool is no part of it.
  SpringNetwork alone = network;
  alone.probe = {};
  forces_alone(alone, rest_m, {still_mps_.data(), n}, {opening_N_.data(), n});
}

void PatchMemory::flow(std::span<Vec3> position_m, std::span<const Vec3> rest_m) RT_SAFE {
  if (!is_on()) return;
  for (std::size_t n = 0; n < position_m.size(); ++n) {
    // du: what the steps have added to z, for within a tick nothing flows and z moves as u does.
    const Vec3 moved_m = relaxed_rest_m_[n] - blend_m(n, position_m[n], rest_m[n]);
    position_m[n] += moved_m;
    for (std::size_t i = 0; i < relaxation_.terms(); ++i) {
      Vec3& stretched = stretched_[i][n];
      stretched = rest_m[n] + fade_[i] * (stretched + moved_m - rest_m[n]);
    }
    relaxed_rest_m_[n] = blend_m(n, position_m[n], rest_m[n]);
  }
}

double PatchMemory::stored_energy_J(const SpringNetwork& network,
                                    std::span<Vec3> position_m) RT_SAFE {
  SpringNetwork at = network;
  at.node.position_m = position_m;
  double energy_J = relaxation_.share(0) * model::springs::stored_energy_J(at);
  for (std::size_t i = 0; i < relaxation_.terms(); ++i) {
    at.node.position_m = {stretched_[i].data(), position_m.size()};
    energy_J += relaxation_.share(i + 1) * model::springs::stored_energy_J(at);
  }
  for (std::size_t n = 0; is_on() && n < position_m.size(); ++n)
    // - c . (u - z): pretension that was cut does not relax.
    energy_J -= dot(opening_N_[n], flowed_m(n, position_m[n]));
  return energy_J;
}

}  // namespace tact::model::springs
