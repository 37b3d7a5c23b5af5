// SPDX-License-Identifier: Apache-2.0
// The integrators of integrators.h on a whole network (spring_network.h).

#include "model/springs/spring_network.h"

namespace tact::model::springs {

SpringStepper::SpringStepper(std::size_t max_nodes, std::size_t max_springs)
    : force_N_(max_nodes),
      position_m_(max_nodes),
      velocity_mps_(max_nodes),
      sum_(max_nodes),
      direction_(max_nodes),
      product_(max_nodes),
      preconditioner_(max_nodes),
      tangent_(max_springs) {}

std::size_t SpringStepper::memory_bytes() const {
  return force_N_.size() * (6 * sizeof(Vec3) + sizeof(double)) + tangent_.size() * sizeof(Tangent);
}

double SpringStepper::step(const SpringNetwork& network, const StepRule& rule) RT_SAFE {
  const SpringNodes& node = network.node;
  const std::size_t n = node.position_m.size();
  const double h = rule.step_s;
  const std::span<Vec3> x = node.position_m, v = node.velocity_mps;
  const std::span<Vec3> f(force_N_.data(), n), x_star(position_m_.data(), n),
      v_star(velocity_mps_.data(), n);
  const std::span<const double> w = node.inverse_mass_per_kg;
  // Of the start: all but implicit Euler need these forces, and the energy comes with them.
  const double energy_J = forces(network, x, v, f);
  switch (rule.method.integrator) {
    case Integrator::kExplicitEuler:
      for (std::size_t i = 0; i < n; ++i) x[i] += h * v[i], v[i] += h * w[i] * f[i];  // MA-2
      break;
    case Integrator::kImprovedEuler:
      for (std::size_t i = 0; i < n; ++i) v[i] += h * w[i] * f[i], x[i] += h * v[i];  // MA-3
      break;
    case Integrator::kMidpointAveraging:
    case Integrator::kRk2: {
      const bool averages = rule.method.integrator == Integrator::kMidpointAveraging;
      const double part = (averages ? rule.method.alpha : 0.5) * h;
      for (std::size_t i = 0; i < n; ++i)
        x_star[i] = x[i] + part * v[i], v_star[i] = v[i] + part * w[i] * f[i];  // MA-4
      forces_alone(network, x_star, v_star, f);
      for (std::size_t i = 0; i < n; ++i) {
        const Vec3 next = v[i] + h * w[i] * f[i];                    // MA-5
        x[i] += averages ? 0.5 * h * (v[i] + next) : h * v_star[i];  // MA-6 or MA-8b
        v[i] = next;
      }
      break;
    }
    case Integrator::kRk4:
      step_rk4(network, h);
      break;
    case Integrator::kImplicitEuler:
      step_implicit(network, h, rule.iterations);
      break;
  }
  return energy_J;
}

// MA-8  x+ = x + h (v_1 + 2 v_2 + 2 v_3 + v_4)/6,   v+ = v + h (a_1 + 2 a_2 + 2 a_3 + a_4)/6
//       v_i = v + p h a_(i-1),   a_i = a(x + p h v_(i-1), v_i),   p = 0, 1/2, 1/2, 1
// force_N_ holds the forces of the start. sum_ and direction_ gather x+ - x and v+ - v.
void SpringStepper::step_rk4(const SpringNetwork& network, double step_s) RT_SAFE {
  const double h = step_s;  // of the equations
  const SpringNodes& node = network.node;
  const std::size_t n = node.position_m.size();
  constexpr std::array kWeight{1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
  constexpr std::array kReach{0.5, 0.5, 1.0};
  for (std::size_t i = 0; i < n; ++i)
    velocity_mps_[i] = node.velocity_mps[i], sum_[i] = direction_[i] = {};
  for (std::size_t stage = 0; stage < 4; ++stage) {
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 slope = velocity_mps_[i], bend = node.inverse_mass_per_kg[i] * force_N_[i];
      sum_[i] += h * kWeight[stage] * slope;
      direction_[i] += h * kWeight[stage] * bend;
      if (stage == 3) continue;
      position_m_[i] = node.position_m[i] + h * kReach[stage] * slope;
      velocity_mps_[i] = node.velocity_mps[i] + h * kReach[stage] * bend;
    }
    if (stage < 3)
      forces_alone(network, {position_m_.data(), n}, {velocity_mps_.data(), n},
                   {force_N_.data(), n});
  }
  for (std::size_t i = 0; i < n; ++i)
    node.position_m[i] += sum_[i], node.velocity_mps[i] += direction_[i];
}

// (M + h C + h^2 K) v+ = M v + h f(x, 0), solved by conjugate gradients from v+ = 0; x+ = x + h v+.
void SpringStepper::step_implicit(const SpringNetwork& network, double step_s,
                                  int iterations) RT_SAFE {
  const double h = step_s;  // of the equations
  const SpringNodes& node = network.node;
  const std::size_t n = node.position_m.size();
  const std::span<const double> w = node.inverse_mass_per_kg;
  linearise(network, h);
  // force_N_ holds the residual (N s), sum_ v+; velocity_mps_ is a zero velocity for f(x, 0)
  for (std::size_t i = 0; i < n; ++i) velocity_mps_[i] = sum_[i] = {};
  forces_alone(network, node.position_m, {velocity_mps_.data(), n}, {force_N_.data(), n});
  double old = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    force_N_[i] = w[i] > 0.0 ? node.velocity_mps[i] / w[i] + h * force_N_[i] : Vec3{};
    direction_[i] = preconditioner_[i] * force_N_[i];
    old += dot(force_N_[i], direction_[i]);
  }
  for (int k = 0; k < iterations && old > 0.0; ++k) {
    apply(network, h, {direction_.data(), n}, {product_.data(), n});
    double curvature = 0.0;
    for (std::size_t i = 0; i < n; ++i) curvature += dot(direction_[i], product_[i]);
    // Nothing is left to do, or something is no number.
    if (!(curvature > 0.0)) break;
    const double reach = old / curvature;
    double fresh = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      sum_[i] += reach * direction_[i];
      force_N_[i] -= reach * product_[i];
      fresh += preconditioner_[i] * dot(force_N_[i], force_N_[i]);
    }
    // Fletcher and Reeves; old > 0 by the loop.
    const double turn = fresh / old;
    for (std::size_t i = 0; i < n; ++i)
      direction_[i] = preconditioner_[i] * force_N_[i] + turn * direction_[i];
    old = fresh;
  }
  for (std::size_t i = 0; i < n; ++i) {
    node.velocity_mps[i] = sum_[i];
    node.position_m[i] += h * sum_[i];
  }
}

void SpringStepper::linearise(const SpringNetwork& network, double step_s) RT_SAFE {
  const double h = step_s;  // of the equations
  const SpringNodes& node = network.node;
  const std::size_t n = node.position_m.size();
  for (std::size_t i = 0; i < n; ++i)
    preconditioner_[i] = h * node.drag_Ns_per_m[i] + h * h * node.anchor_N_per_m[i];
  for (std::size_t k = 0; k < network.spring.size(); ++k) {
    const Spring& s = network.spring[k];
    Tangent& t = tangent_[k];
    const Vec3 along_m = node.position_m[s.j] - node.position_m[s.i];
    const double length_m = norm(along_m);
    t = {};
    if (!(length_m > 0.0)) continue;
    const double squeeze = 1.0 - s.rest_length_m / length_m;
    t.direction = (1.0 / length_m) * along_m;
    t.along = h * s.damping_Ns_per_m + h * h * s.stiffness_N_per_m;
    // A compressed spring buckles sideways: its negative stiffness is
    // left out, or the matrix might not be definite.
    t.across = squeeze > 0.0 ? h * h * s.stiffness_N_per_m * squeeze : 0.0;
    // The mean of its three axes: one number a node as
    // preconditioner, for any direction of the springs.
    const double mean = (t.along + 2.0 * t.across) / 3.0;
    preconditioner_[s.i] += mean;
    preconditioner_[s.j] += mean;
  }
  for (std::size_t p = 0; p < network.probe.size() && p < probe_pushes_.size(); ++p) {
    const ProbeSpring& probe = network.probe[p];
    // Decided once a step: the matrix must stay the same for all iterations.
    probe_pushes_[p] =
        probe.stiffness_N_per_m > 0.0 &&
        probe_force_N(probe, indentation_m(probe, node.position_m, node.rest_m)) != 0.0;
    if (!probe_pushes_[p]) continue;
    const double q = h * probe.damping_Ns_per_m + h * h * probe.stiffness_N_per_m;
    for (std::size_t c = 0; c < 3; ++c)
      preconditioner_[probe.node[c]] += q * probe.weight[c] * probe.weight[c] / 3.0;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double w = node.inverse_mass_per_kg[i];
    preconditioner_[i] = w > 0.0 ? 1.0 / (1.0 / w + preconditioner_[i]) : 0.0;
  }
}

// out = (M + h C + h^2 K) in; a node that never moves takes no part.
void SpringStepper::apply(const SpringNetwork& network, double step_s, std::span<const Vec3> in,
                          std::span<Vec3> out) const RT_SAFE {
  const double h = step_s;  // of the equations
  const SpringNodes& node = network.node;
  const std::span<const double> w = node.inverse_mass_per_kg;
  for (std::size_t i = 0; i < in.size(); ++i) {
    const double own = h * node.drag_Ns_per_m[i] + h * h * node.anchor_N_per_m[i];
    out[i] = w[i] > 0.0 ? (1.0 / w[i] + own) * in[i] : Vec3{};
  }
  for (std::size_t k = 0; k < network.spring.size(); ++k) {
    const Spring& s = network.spring[k];
    const Tangent& t = tangent_[k];
    const Vec3 apart = in[s.j] - in[s.i];
    const Vec3 pull =
        (t.along - t.across) * dot(t.direction, apart) * t.direction + t.across * apart;
    out[s.i] -= pull;
    out[s.j] += pull;
  }
  for (std::size_t p = 0; p < network.probe.size() && p < probe_pushes_.size(); ++p) {
    if (!probe_pushes_[p]) continue;
    const ProbeSpring& probe = network.probe[p];
    double indentation = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      indentation += probe.weight[c] * dot(probe.push[c], in[probe.node[c]]);
    const double q = (h * probe.damping_Ns_per_m + h * h * probe.stiffness_N_per_m) * indentation;
    for (std::size_t c = 0; c < 3; ++c) out[probe.node[c]] += q * probe.weight[c] * probe.push[c];
  }
  for (std::size_t i = 0; i < in.size(); ++i)
    if (!(w[i] > 0.0)) out[i] = {};
}

}  // namespace tact::model::springs
