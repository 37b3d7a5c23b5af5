// SPDX-License-Identifier: Apache-2.0
// spring_mesh.h - a square net of masses and springs with its own storage, for tests.
#pragma once

#include <cstdint>
#include <vector>

#include "model/springs/spring_network.h"

namespace tact::tests {

/// cells x cells squares with diagonals in z = 0, corners fixed; shake_m displaces the start.
struct SpringNet {
  std::vector<model::Vec3> position_m, velocity_mps, rest_m, load_N;
  std::vector<double> inverse_mass_per_kg, anchor_N_per_m, drag_Ns_per_m;
  std::vector<model::springs::Spring> spring;
  std::vector<model::springs::ProbeSpring> probe;

  model::springs::SpringNetwork view() {
    return {.node = {position_m, velocity_mps, rest_m, load_N, inverse_mass_per_kg, anchor_N_per_m,
                     drag_Ns_per_m},
            .spring = spring,
            .probe = probe};
  }
  double energy_J() { return stored_energy_J(view()) + kinetic_energy_J(view()); }
};

struct NetMaterial {
  double pitch_m = 0.01, mass_kg = 0.002, stiffness_N_per_m = 50.0, damping_Ns_per_m = 0.0;
  double anchor_N_per_m = 5.0, drag_Ns_per_m = 0.0, shake_m = 0.0;
};

inline SpringNet make_net(std::uint32_t cells, const NetMaterial& m) {
  SpringNet net;
  std::uint32_t seed = 1;
  const auto random = [&seed] {  // -1 .. 1, the same everywhere
    seed = seed * 1664525u + 1013904223u;
    return static_cast<double>(seed >> 8) / 8388608.0 - 1.0;
  };
  const std::uint32_t side = cells + 1;
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const bool corner = (x == 0 || x == cells) && (y == 0 || y == cells);
      net.rest_m.push_back({m.pitch_m * x, m.pitch_m * y, 0.0});
      const model::Vec3 shake{random(), random(), random()};
      net.position_m.push_back(net.rest_m.back() + (corner ? 0.0 : m.shake_m) * shake);
      net.velocity_mps.push_back({});
      net.load_N.push_back({});
      net.inverse_mass_per_kg.push_back(corner ? 0.0 : 1.0 / m.mass_kg);
      net.anchor_N_per_m.push_back(m.anchor_N_per_m);
      net.drag_Ns_per_m.push_back(m.drag_Ns_per_m);
      const auto join = [&](std::uint32_t i, std::uint32_t j) {
        net.spring.push_back(
            {i, j, m.stiffness_N_per_m, m.damping_Ns_per_m, norm(net.rest_m[j] - net.rest_m[i])});
      };
      const std::uint32_t here = y * side + x;
      if (x > 0) join(here - 1, here);
      if (y > 0) join(here - side, here);
      if (x > 0 && y > 0) join(here - side - 1, here);
    }
  }
  return net;
}

inline model::springs::StepRule rule(model::springs::Integrator integrator, double step_s,
                                     double alpha = 0.5) {
  return {.method = {integrator, alpha}, .step_s = step_s};
}

inline void run(SpringNet& net, const model::springs::StepRule& how, int steps) {
  model::springs::SpringStepper stepper(net.rest_m.size(), net.spring.size());
  for (int i = 0; i < steps; ++i) stepper.step(net.view(), how);
}

}  // namespace tact::tests
