// SPDX-License-Identifier: Apache-2.0
#include "model/springs/spring_network.h"

#include <cmath>
#include <cstring>

namespace tact::model::springs {
namespace {

// Two springs in one instruction: SSE2 and NEON have two doubles. Each lane rounds as a double
// alone does, and forces are added in the order of the springs: the bits are those of one by one.
using Pair [[gnu::vector_size(2 * sizeof(double))]] = double;

Pair pair_of(double a, double b) RT_SAFE { return Pair{a, b}; }
Pair firsts(const Pair& a, const Pair& b) RT_SAFE { return Pair{a[0], b[0]}; }
Pair seconds(const Pair& a, const Pair& b) RT_SAFE { return Pair{a[1], b[1]}; }
Pair root(const Pair& a) RT_SAFE { return Pair{std::sqrt(a[0]), std::sqrt(a[1])}; }

// x and y lie side by side in a Vec3: one load of 16 bytes.
Pair xy(const Vec3& v) RT_SAFE {
  Pair out;
  std::memcpy(&out, &v, sizeof out);
  return out;
}
// One store of 16 bytes, which the next load of 16 bytes can take over.
void add(Vec3& v, const Pair& xy_part, double z_part) RT_SAFE {
  const Pair sum = xy(v) + xy_part;
  std::memcpy(static_cast<void*>(&v), &sum, sizeof sum);
  v.z += z_part;
}
void take(Vec3& v, const Pair& xy_part, double z_part) RT_SAFE {
  const Pair rest = xy(v) - xy_part;
  std::memcpy(static_cast<void*>(&v), &rest, sizeof rest);
  v.z -= z_part;
}

struct Vec3Pair {
  Pair x, y, z;  // of two vectors
};
/// From i to j, of two springs.
Vec3Pair apart(const Vec3& i0, const Vec3& j0, const Vec3& i1, const Vec3& j1) RT_SAFE {
  const Pair xy0 = xy(j0) - xy(i0), xy1 = xy(j1) - xy(i1);
  return {firsts(xy0, xy1), seconds(xy0, xy1), pair_of(j0.z, j1.z) - pair_of(i0.z, i1.z)};
}
Pair dot(const Vec3Pair& a, const Vec3Pair& b) RT_SAFE { return a.x * b.x + a.y * b.y + a.z * b.z; }

struct Pull {
  Vec3Pair force_N;  // on the first end
  Pair stored_J;
};
template <bool kWithEnergy>
inline Pull pull(const Spring& s, const Spring& t, const Vec3* x, const Vec3* v) RT_SAFE {
  const Vec3Pair along_m = apart(x[s.i], x[s.j], x[t.i], x[t.j]);
  const Vec3Pair rate_mps = apart(v[s.i], v[s.j], v[t.i], v[t.j]);
  const Pair length_m = root(dot(along_m, along_m));
  const Pair stretch_m = length_m - pair_of(s.rest_length_m, t.rest_length_m);
  const Pair tension_N = pair_of(s.stiffness_N_per_m, t.stiffness_N_per_m) * stretch_m;
  Pull out;
  if constexpr (kWithEnergy) out.stored_J = 0.5 * tension_N * stretch_m;
  // MA-1  k (|D| - L0) + c (v_j - v_i).u
  // A spring of no length has no direction: it pulls nowhere.
  const Pair per_m = length_m > 0.0 ? 1.0 / length_m : Pair{};
  const Vec3Pair u{per_m * along_m.x, per_m * along_m.y, per_m * along_m.z};
  const Pair pull_N =
      tension_N + pair_of(s.damping_Ns_per_m, t.damping_Ns_per_m) * dot(rate_mps, u);
  out.force_N = {pull_N * u.x, pull_N * u.y, pull_N * u.z};
  return out;
}

template <bool kWithEnergy>
double add_springs(std::span<const Spring> springs, const Vec3* x, const Vec3* v, Vec3* f,
                   double energy_J) RT_SAFE {
  const Spring* s = springs.data();
  const Spring* const last = s + springs.size() / 2 * 2;
  for (; s != last; s += 2) {
    const Spring& t = s[1];
    const Pull p = pull<kWithEnergy>(*s, t, x, v);
    if constexpr (kWithEnergy) energy_J = energy_J + p.stored_J[0] + p.stored_J[1];
    const Pair of_s = firsts(p.force_N.x, p.force_N.y), of_t = seconds(p.force_N.x, p.force_N.y);
    add(f[s->i], of_s, p.force_N.z[0]);
    take(f[s->j], of_s, p.force_N.z[0]);
    add(f[t.i], of_t, p.force_N.z[1]);
    take(f[t.j], of_t, p.force_N.z[1]);
  }
  // The odd one is computed twice and counted once.
  if (springs.size() % 2 == 1) {
    const Pull p = pull<kWithEnergy>(*s, *s, x, v);
    if constexpr (kWithEnergy) energy_J += p.stored_J[0];
    add(f[s->i], firsts(p.force_N.x, p.force_N.y), p.force_N.z[0]);
    take(f[s->j], firsts(p.force_N.x, p.force_N.y), p.force_N.z[0]);
  }
  return energy_J;
}

/// What a node takes before its springs.
Vec3 own_force_N(const SpringNodes& node, std::size_t i, const Vec3& moved_m,
                 const Vec3& v) RT_SAFE {
  return node.load_N[i] - node.drag_Ns_per_m[i] * v - node.anchor_N_per_m[i] * moved_m;
}

// Adds what the tool's springs do to their nodes.
void add_probes(const SpringNetwork& network, std::span<const Vec3> x, std::span<const Vec3> v,
                std::span<Vec3> f) RT_SAFE {
  for (const ProbeSpring& probe : network.probe) {
    if (probe.stiffness_N_per_m == 0.0) continue;
    const double push_N = probe_force_N(probe, indentation_m(probe, x, network.node.rest_m));
    if (push_N == 0.0) continue;
    double rate_mps = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      rate_mps += probe.weight[c] * dot(probe.push[c], v[probe.node[c]]);
    double total_N = push_N - probe.damping_Ns_per_m * rate_mps;
    // Damping may take the push away, but not turn it
    // into a pull: tissue does not stick to the tool.
    if (!probe.held && !(total_N > 0.0)) total_N = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      f[probe.node[c]] += total_N * probe.weight[c] * probe.push[c];
  }
}

}  // namespace

double indentation_m(const ProbeSpring& probe, std::span<const Vec3> position_m,
                     std::span<const Vec3> rest_m) RT_SAFE {
  double w = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::uint32_t i = probe.node[c];
    w += probe.weight[c] * dot(probe.push[c], position_m[i] - rest_m[i]);
  }
  return w;
}

double probe_force_N(const ProbeSpring& probe, double indentation_m) RT_SAFE {
  const double f = probe.stiffness_N_per_m * (probe.depth_m - indentation_m);
  return probe.held || f > 0.0 ? f : 0.0;
}

double forces(const SpringNetwork& network, std::span<const Vec3> x, std::span<const Vec3> v,
              std::span<Vec3> f) RT_SAFE {
  const SpringNodes& node = network.node;
  double energy_J = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 moved_m = x[i] - node.rest_m[i];
    f[i] = own_force_N(node, i, moved_m, v[i]);
    energy_J += 0.5 * node.anchor_N_per_m[i] * model::dot(moved_m, moved_m) -
                model::dot(node.load_N[i], moved_m);
  }
  energy_J = add_springs<true>(network.spring, x.data(), v.data(), f.data(), energy_J);
  add_probes(network, x, v, f);
  return energy_J;
}

void forces_alone(const SpringNetwork& network, std::span<const Vec3> x, std::span<const Vec3> v,
                  std::span<Vec3> f) RT_SAFE {
  for (std::size_t i = 0; i < x.size(); ++i)
    f[i] = own_force_N(network.node, i, x[i] - network.node.rest_m[i], v[i]);
  add_springs<false>(network.spring, x.data(), v.data(), f.data(), 0.0);
  add_probes(network, x, v, f);
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
