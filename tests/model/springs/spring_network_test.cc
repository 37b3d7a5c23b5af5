// SPDX-License-Identifier: Apache-2.0
#include "model/springs/spring_network.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/springs/spring_mesh.h"
#include "tests/support/no_alloc.h"

namespace tact::model::springs::spring_network_test {

using tests::make_net;
using tests::rule;
using tests::run;
using tests::SpringNet;

TEST(SpringNetwork, MatchesPenAndPaper) {
  // Two nodes 30 mm apart, L0 = 20 mm, k = 200 N/m: 2 N. Apart at 0.1 m/s, c = 3 Ns/m: 0.3 N more.
  SpringNet net = make_net(1, {});
  net.spring = {{0, 1, 200.0, 3.0, 0.02}};
  net.position_m = net.rest_m = {{0, 0, 0}, {0.03, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  net.velocity_mps[1] = {0.1, 0.5, 0.0};
  std::vector<Vec3> f(4);
  const double energy_J = forces(net.view(), net.position_m, net.velocity_mps, f);
  EXPECT_NEAR(f[0].x, 2.3, 1e-12);
  EXPECT_NEAR(f[1].x, -2.3, 1e-12);
  EXPECT_EQ(f[1].y, 0.0) << "moving across a spring takes no force";
  EXPECT_NEAR(energy_J, 0.01, 1e-15);  // 200 * 0.01^2 / 2
  // A probe 4 mm deep on an indentation of 1 mm with 300 N/m pushes with 0.9 N.
  ProbeSpring probe{
      .node = {0, 1, 2}, .weight = {0.5, 0.25, 0.25}, .depth_m = 0.004, .stiffness_N_per_m = 300.0};
  probe.push.fill({0, 0, -1});
  net.position_m[0].z = -0.002;
  EXPECT_NEAR(indentation_m(probe, net.position_m, net.rest_m), 0.001, 1e-15);
  EXPECT_NEAR(probe_force_N(probe, 0.001), 0.9, 1e-12);
  EXPECT_EQ(probe_force_N(probe, 0.005), 0.0) << "it never pulls";
  probe.held = true;
  EXPECT_NEAR(probe_force_N(probe, 0.005), -0.3, 1e-12) << "unless held";
}

TEST(SpringNetwork, ForceIsTheSlopeOfItsEnergy) {
  SpringNet net = make_net(3, {.shake_m = 0.003});
  for (Vec3& load : net.load_N) load = {0.1, -0.2, 0.05};
  std::vector<Vec3> f(net.rest_m.size());
  forces(net.view(), net.position_m, net.velocity_mps, f);
  const double e = 1e-7;
  for (std::size_t i = 0; i < f.size(); ++i) {
    for (double Vec3::* axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      const double here = net.position_m[i].*axis;
      net.position_m[i].*axis = here + e;
      const double ahead_J = stored_energy_J(net.view());
      net.position_m[i].*axis = here - e;
      const double behind_J = stored_energy_J(net.view());
      net.position_m[i].*axis = here;
      EXPECT_NEAR(-(ahead_J - behind_J) / (2.0 * e), f[i].*axis, 1e-6);
    }
  }
}

// Springs are worked two at a time; an odd one is left over.
TEST(SpringNetwork, ForcesAreThoseOfOneSpringAfterTheOtherToTheLastBit) {
  for (const std::uint32_t cells : {3u, 4u}) {
    SpringNet net =
        make_net(cells, {.damping_Ns_per_m = 0.02, .drag_Ns_per_m = 0.1, .shake_m = 0.003});
    for (std::size_t i = 0; i < net.rest_m.size(); ++i)
      net.velocity_mps[i] = 20.0 * (net.position_m[i] - net.rest_m[i]);
    net.position_m[1] = net.position_m[0];  // a spring of no length pulls nowhere
    std::vector<Vec3> want(net.rest_m.size()), f = want, alone = want;
    for (std::size_t i = 0; i < want.size(); ++i)
      want[i] = net.load_N[i] - net.drag_Ns_per_m[i] * net.velocity_mps[i] -
                net.anchor_N_per_m[i] * (net.position_m[i] - net.rest_m[i]);
    for (const Spring& s : net.spring) {
      const Vec3 along_m = net.position_m[s.j] - net.position_m[s.i];
      if (norm(along_m) == 0.0) continue;
      const Vec3 u = (1.0 / norm(along_m)) * along_m;
      const double rate_mps = dot(net.velocity_mps[s.j] - net.velocity_mps[s.i], u);
      const Vec3 pull_N = (s.stiffness_N_per_m * (norm(along_m) - s.rest_length_m) +
                           s.damping_Ns_per_m * rate_mps) *
                          u;
      want[s.i] += pull_N;
      want[s.j] -= pull_N;
    }
    const double energy_J = forces(net.view(), net.position_m, net.velocity_mps, f);
    forces_alone(net.view(), net.position_m, net.velocity_mps, alone);
    for (std::size_t i = 0; i < want.size(); ++i) {
      EXPECT_EQ(f[i], want[i]) << i << " of " << cells << " cells, " << net.spring.size();
      EXPECT_EQ(alone[i], want[i]) << i;
    }
    EXPECT_NEAR(energy_J, stored_energy_J(net.view()), 1e-15);
  }
}

TEST(SpringNetwork, SpringsAloneKeepTheMomentum) {
  SpringNet net = make_net(4, {.damping_Ns_per_m = 0.02, .anchor_N_per_m = 0.0, .shake_m = 0.003});
  net.inverse_mass_per_kg.assign(net.rest_m.size(), 500.0);
  for (const auto& entry : kIntegratorNames) {
    run(net, rule(entry.integrator, 0.0005), 20);
    Vec3 sum;
    for (const Vec3& v : net.velocity_mps) sum += v;
    EXPECT_NEAR(norm(sum), 0.0, 1e-12) << entry.name;
  }
}

TEST(SpringNetwork, FixedNodesAndRestStayWhereTheyAre) {
  for (const auto& entry : kIntegratorNames) {
    SpringNet shaken = make_net(3, {.shake_m = 0.002}), still = make_net(3, {});
    run(shaken, rule(entry.integrator, 0.001), 50);
    EXPECT_EQ(shaken.position_m[0], shaken.rest_m[0]) << entry.name;
    EXPECT_EQ(shaken.velocity_mps[0], Vec3{}) << entry.name;
    run(still, rule(entry.integrator, 0.001), 50);
    for (std::size_t i = 0; i < still.rest_m.size(); ++i)
      EXPECT_EQ(still.position_m[i], still.rest_m[i]) << entry.name;
  }
}

TEST(SpringNetwork, SkipsASpringOfNoLength) {
  for (const auto& entry : kIntegratorNames) {
    SpringNet net = make_net(2, {});
    net.position_m[4] = net.position_m[3];
    run(net, rule(entry.integrator, 0.001), 10);
    for (const Vec3& x : net.position_m) EXPECT_TRUE(is_finite(x)) << entry.name;
  }
}

TEST(SpringNetwork, ASpringOfNoLengthKeepsItsEnergyInBothCounts) {
  SpringNet net = make_net(2, {.shake_m = 1e-3});
  net.position_m[4] = net.position_m[3];
  std::vector<Vec3> f(net.rest_m.size());
  const double energy_J = forces(net.view(), net.position_m, net.velocity_mps, f);
  EXPECT_NEAR(energy_J, stored_energy_J(net.view()), 1e-12 * energy_J);
}

// Nodes that flee from an unheld tool faster than it pushes are let go, not drawn back.
TEST(SpringNetwork, DampingUnderAToolPullsOnlyIfHeld) {
  SpringNet net = make_net(1, {.anchor_N_per_m = 0.0});
  net.spring.clear();
  ProbeSpring probe{.node = {0, 1, 2},
                    .weight = {0.5, 0.25, 0.25},
                    .depth_m = 0.001,
                    .stiffness_N_per_m = 300.0,
                    .damping_Ns_per_m = 2.0};
  probe.push.fill({0, 0, -1});
  for (Vec3& v : net.velocity_mps) v = {0, 0, -1.0};  // 0.3 N of push, 2 N of damping
  std::vector<Vec3> f(net.rest_m.size());
  for (const bool held : {false, true}) {
    probe.held = held;
    SpringNetwork network = net.view();
    network.probe = {&probe, 1};
    forces(network, net.position_m, net.velocity_mps, f);
    EXPECT_NEAR(f[0].z, held ? 0.5 * 1.7 : 0.0, 1e-12);
  }
}

TEST(SpringNetwork, HasConsistentDimensions) {
  const double m = 1e3, kg = 7.0, s = 0.3;
  const double force = kg * m / (s * s), stiff = kg / (s * s), damp = kg / s;
  for (const auto& entry : kIntegratorNames) {
    SpringNet plain =
        make_net(3, {.damping_Ns_per_m = 0.02, .drag_Ns_per_m = 0.01, .shake_m = 1e-3});
    SpringNet scaled = make_net(3, {.pitch_m = 0.01 * m,
                                    .mass_kg = 0.002 * kg,
                                    .stiffness_N_per_m = 50.0 * stiff,
                                    .damping_Ns_per_m = 0.02 * damp,
                                    .anchor_N_per_m = 5.0 * stiff,
                                    .drag_Ns_per_m = 0.01 * damp,
                                    .shake_m = 1e-3 * m});
    plain.load_N[5] = {0.0, 0.0, 0.1};
    scaled.load_N[5] = {0.0, 0.0, 0.1 * force};
    run(plain, rule(entry.integrator, 0.001), 20);
    run(scaled, rule(entry.integrator, 0.001 * s), 20);
    for (std::size_t i = 0; i < plain.rest_m.size(); ++i)
      EXPECT_NEAR(norm(scaled.position_m[i] - m * plain.position_m[i]), 0.0, 1e-9 * m)
          << entry.name;
  }
}

TEST(SpringNetwork, LeavesTheHeapAlone) {
  SpringNet net = make_net(5, {.shake_m = 1e-3});
  SpringStepper stepper(net.rest_m.size(), net.spring.size());
  const SpringNetwork view = net.view();
  const tests::NoAlloc guard;
  for (const auto& entry : kIntegratorNames) stepper.step(view, rule(entry.integrator, 0.001));
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::model::springs::spring_network_test
