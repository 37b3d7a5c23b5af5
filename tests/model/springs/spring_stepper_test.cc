// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "model/springs/spring_network.h"
#include "tests/model/springs/spring_mesh.h"
#include "tests/support/no_alloc.h"

namespace tact::model::springs::spring_stepper_test {

using tests::make_net;
using tests::rule;
using tests::run;
using tests::SpringNet;

TEST(SpringStepper, ThreeEighthsMakesEnergyWhereOneHalfKeepsIt) {
  const auto growth = [](double alpha) {
    SpringNet net = make_net(6, {.shake_m = 0.0001});
    const double before_J = net.energy_J();
    run(net, rule(Integrator::kMidpointAveraging, 0.001, alpha), 2000);
    return net.energy_J() / before_J;
  };
  EXPECT_GT(growth(0.375), 10.0);
  EXPECT_NEAR(growth(0.5), 1.0, 0.2);
  EXPECT_LT(growth(0.625), 0.5);
}

// The theorem in the header: any number of iterations, any step.
TEST(SpringStepper, ImplicitEulerNeverMakesEnergyHoweverFewItsIterations) {
  for (const int iterations : {1, 2, 5, 30}) {
    for (const double step_s : {0.001, 0.01, 1.0}) {
      SpringNet net = make_net(8, {.shake_m = 1e-6});  // small: springs are linear
      net.anchor_N_per_m[20] = 5000.0;
      SpringStepper stepper(net.rest_m.size(), net.spring.size());
      double before_J = net.energy_J();
      for (int i = 0; i < 100; ++i) {
        stepper.step(
            net.view(),
            {.method = {Integrator::kImplicitEuler}, .step_s = step_s, .iterations = iterations});
        const double after_J = net.energy_J();
        ASSERT_LE(after_J, before_J * (1.0 + 1e-3) + 1e-18) << iterations << ", " << step_s;
        before_J = after_J;
      }
    }
  }
}

// A crumpled net: many springs are pressed together and would have negative stiffness across.
TEST(SpringStepper, ImplicitEulerSettlesForAnyStartAndStep) {
  for (const double step_s : {0.001, 0.01, 0.1}) {
    SpringNet net = make_net(6, {.shake_m = 0.02});
    const double before_J = net.energy_J();
    run(net, {.method = {Integrator::kImplicitEuler}, .step_s = step_s, .iterations = 20}, 300);
    EXPECT_LT(net.energy_J(), 0.2 * before_J) << step_s;
    const double then_J = net.energy_J();
    run(net, {.method = {Integrator::kImplicitEuler}, .step_s = step_s, .iterations = 20}, 300);
    EXPECT_LE(net.energy_J(), then_J * (1.0 + 1e-9)) << step_s;
  }
}

TEST(SpringStepper, ImplicitEulerConvergesToItsScalarForm) {
  // One free node on an anchor: MA-9 on each axis.
  SpringNet net = make_net(1, {.stiffness_N_per_m = 0.0, .drag_Ns_per_m = 0.01});
  net.inverse_mass_per_kg[1] = 500.0;
  net.position_m[1] += {0.002, 0.0, 0.001};
  OscillatorState at{0.002, 0.0};
  for (int i = 0; i < 10; ++i)
    at = step({0.002, 0.01, 5.0, 0.0}, at, {Integrator::kImplicitEuler}, 0.001);
  run(net, rule(Integrator::kImplicitEuler, 0.001), 10);
  EXPECT_NEAR(net.position_m[1].x - net.rest_m[1].x, at.position_m, 1e-15);
  EXPECT_NEAR(net.position_m[1].z, 0.5 * at.position_m, 1e-15);
}

TEST(SpringStepper, EveryIntegratorFindsTheSameRest) {
  std::vector<double> depth_m;
  for (const auto& entry : kIntegratorNames) {
    SpringNet net = make_net(6, {.damping_Ns_per_m = 0.1, .drag_Ns_per_m = 0.1});
    net.load_N[24] = {0.0, 0.0, -0.02};
    run(net, rule(entry.integrator, 0.0005), 3000);
    depth_m.push_back(net.position_m[24].z);
  }
  for (const double d : depth_m) EXPECT_NEAR(d / depth_m[0], 1.0, 1e-6);
}

}  // namespace tact::model::springs::spring_stepper_test
