// SPDX-License-Identifier: Apache-2.0
// spring_network.h - masses joined by springs: forces, stored energy, a step of each integrator.
//
//     MA-1  f_i = load_i - g_i v_i - a_i (x_i - X_i) + sum_j [ k (|D| - L0) + c (v_j - v_i).u ] u
//           D = x_j - x_i,  u = D / |D|;  a spring of no length has energy, but
//           no direction to pull in
//     probe f = q (depth - w),  w = sum of weight_i p_i.(x_i - X_i)    along p_i on node i:
//           a virtual spring from the tool; unless held it never pulls, nor does its damping of
//           the nodes (but implicit Euler, which keeps both for the step that it begins pushing)
//
//     x, v, X  position, velocity, rest position    load  constant force, N    g  drag, N s/m
//     a  anchor, N/m: the body under the surface    k, c, L0  of a spring      p  unit, inward
//
// All nodes are advanced together. A node with inverse mass 0 never moves. The network owns
// nothing: its owner gathers the nodes and springs that are to be stepped and leaves the rest
// alone.
//
// Implicit Euler solves the springs linearised at x, without the part of their stiffness that is
// negative under compression, by a fixed count of preconditioned conjugate gradients from v+ = 0.
// The residual is then orthogonal to v+ at every count, and with it the energy of linear springs
// never grows: too few iterations damp, they cannot blow up. Source: MA-1, MA-9.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "model/contact/indentation_view.h"
#include "model/springs/integrators.h"
#include "model/types.h"

namespace tact::model::springs {

struct Spring {
  std::uint32_t i = 0, j = 0;  // nodes
  double stiffness_N_per_m = 0.0;
  double damping_Ns_per_m = 0.0;
  double rest_length_m = 0.0;
};

/// The tool's virtual spring on the three corners of a triangle.
struct ProbeSpring {
  std::array<std::uint32_t, 3> node{};
  std::array<double, 3> weight{};
  std::array<Vec3, 3> push{};  // p: unit, into the tissue
  double depth_m = 0.0;
  double stiffness_N_per_m = 0.0;  // q; 0: no tool
  double damping_Ns_per_m = 0.0;   // of the tissue's movement under the tool
  bool held = false;
};

/// Spans of equal length, one entry a node.
struct SpringNodes {
  std::span<Vec3> position_m;
  std::span<Vec3> velocity_mps;
  std::span<const Vec3> rest_m;
  std::span<const Vec3> load_N;
  std::span<const double> inverse_mass_per_kg;
  std::span<const double> anchor_N_per_m;
  std::span<const double> drag_Ns_per_m;
};

struct SpringNetwork {
  SpringNodes node;
  std::span<const Spring> spring;
  std::span<const ProbeSpring> probe;
};

/// w of a probe at these positions.
double indentation_m(const ProbeSpring& probe, std::span<const Vec3> position_m,
                     std::span<const Vec3> rest_m) RT_SAFE;
/// Force of the virtual spring on the tool at an indentation w.
double probe_force_N(const ProbeSpring& probe, double indentation_m) RT_SAFE;

/// MA-1 for every node, into force_N; returns the energy stored in springs, anchors and loads.
double forces(const SpringNetwork& network, std::span<const Vec3> position_m,
              std::span<const Vec3> velocity_mps, std::span<Vec3> force_N) RT_SAFE;
/// The same forces to the last bit.
void forces_alone(const SpringNetwork& network, std::span<const Vec3> position_m,
                  std::span<const Vec3> velocity_mps, std::span<Vec3> force_N) RT_SAFE;
/// The same energy, J, without forces; probes are not counted.
double stored_energy_J(const SpringNetwork& network) RT_SAFE;
double kinetic_energy_J(const SpringNetwork& network) RT_SAFE;

struct StepRule {
  Method method{};
  double step_s = 0.0;
  int iterations = 10;  // of implicit Euler
};

/// Steps networks of up to a number of nodes and springs. Memory is taken when it is made.
class SpringStepper {
 public:
  SpringStepper(std::size_t max_nodes, std::size_t max_springs);

  /// Nodes and springs beyond the capacity are not allowed. Returns the energy stored before.
  double step(const SpringNetwork& network, const StepRule& rule) RT_SAFE;
  std::size_t memory_bytes() const;

 private:
  struct Tangent {        // of one spring: force -(along u u^T + across (I - u u^T)) (x_j - x_i)
    Vec3 direction{};     // u
    double along = 0.0;   // of h c + h^2 k
    double across = 0.0;  // of h^2 k (1 - L0 / |D|), not below 0
  };

  void step_rk4(const SpringNetwork& network, double step_s) RT_SAFE;
  void step_implicit(const SpringNetwork& network, double step_s, int iterations) RT_SAFE;
  void linearise(const SpringNetwork& network, double step_s) RT_SAFE;
  void apply(const SpringNetwork& network, double step_s, std::span<const Vec3> in,
             std::span<Vec3> out) const RT_SAFE;

  std::vector<Vec3> force_N_, position_m_, velocity_mps_, sum_, direction_, product_;
  std::vector<double> preconditioner_;
  std::vector<Tangent> tangent_;
  std::array<bool, contact::kMaxSpheres> probe_pushes_{};
};

}  // namespace tact::model::springs
