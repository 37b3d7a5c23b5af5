// SPDX-License-Identifier: Apache-2.0
#include "model/springs/spring_network.h"

#include <algorithm>
#include <cmath>

namespace tact::model::springs {
namespace {

// Adds what the tool's springs do to their nodes.
void add_probes(const SpringNetwork& network, std::span<const Vec3> x, std::span<const Vec3> v,
                std::span<Vec3> f) RT_SAFE {
  for (const ProbeSpring& probe : network.probe) {
    if (probe.stiffness_N_per_m == 0.0) continue;
    const double push_N = probe_force_N(probe, dent_m(probe, x, network.node.rest_m));
    if (push_N == 0.0) continue;
    double rate_mps = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      rate_mps += probe.weight[c] * dot(probe.push[c], v[probe.node[c]]);
    double total_N = push_N - probe.damping_Ns_per_m * rate_mps;
    if (!probe.held && !(total_N > 0.0)) total_N = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      f[probe.node[c]] += total_N * probe.weight[c] * probe.push[c];
  }
}

}  // namespace

double dent_m(const ProbeSpring& probe, std::span<const Vec3> position_m,
              std::span<const Vec3> rest_m) RT_SAFE {
  double w = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::uint32_t i = probe.node[c];
    w += probe.weight[c] * dot(probe.push[c], position_m[i] - rest_m[i]);
  }
  return w;
}

double probe_force_N(const ProbeSpring& probe, double dent_m) RT_SAFE {
  const double f = probe.stiffness_N_per_m * (probe.depth_m - dent_m);
  return probe.held || f > 0.0 ? f : 0.0;
}

double forces(const SpringNetwork& network, std::span<const Vec3> x, std::span<const Vec3> v,
              std::span<Vec3> f) RT_SAFE {
  const SpringNodes& node = network.node;
  double energy_J = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 moved_m = x[i] - node.rest_m[i];
    const double a = node.anchor_N_per_m[i];
    f[i] = node.load_N[i] - node.drag_Ns_per_m[i] * v[i] - a * moved_m;
    energy_J += 0.5 * a * dot(moved_m, moved_m) - dot(node.load_N[i], moved_m);
  }
  for (const Spring& s : network.spring) {
    const Vec3 along_m = x[s.j] - x[s.i];
    const double length_m = norm(along_m);
    const double stretch_m = length_m - s.rest_length_m;
    const double tension_N = s.stiffness_N_per_m * stretch_m;
    energy_J += 0.5 * tension_N * stretch_m;
    if (!(length_m > 0.0)) continue;
    // MA-1  k (|D| - L0) + c (v_j - v_i).u
    const Vec3 u = (1.0 / length_m) * along_m;
    const Vec3 pull_N = (tension_N + s.damping_Ns_per_m * dot(v[s.j] - v[s.i], u)) * u;
    f[s.i] += pull_N;
    f[s.j] -= pull_N;
  }
  add_probes(network, x, v, f);
  return energy_J;
}

double stored_energy_J(const SpringNetwork& network) RT_SAFE {
  const SpringNodes& node = network.node;
  double energy_J = 0.0;
  for (std::size_t i = 0; i < node.position_m.size(); ++i) {
    const Vec3 moved_m = node.position_m[i] - node.rest_m[i];
    energy_J += 0.5 * node.anchor_N_per_m[i] * dot(moved_m, moved_m) - dot(node.load_N[i], moved_m);
  }
  for (const Spring& s : network.spring) {
    const double stretch_m = norm(node.position_m[s.j] - node.position_m[s.i]) - s.rest_length_m;
    energy_J += 0.5 * s.stiffness_N_per_m * stretch_m * stretch_m;
  }
  return energy_J;
}

double kinetic_energy_J(const SpringNetwork& network) RT_SAFE {
  double energy_J = 0.0;
  for (std::size_t i = 0; i < network.node.position_m.size(); ++i) {
    const Vec3& v = network.node.velocity_mps[i];
    const double inverse = network.node.inverse_mass_per_kg[i];
    if (inverse > 0.0) energy_J += 0.5 * dot(v, v) / inverse;
  }
  return energy_J;
}

}  // namespace tact::model::springs
