// SPDX-License-Identifier: Apache-2.0
#include "model/springs/spring_step_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/model/springs/spring_mesh.h"

namespace tact::model::springs::spring_step_check_test {

using tests::make_net;
using tests::NetMaterial;
using tests::SpringNet;

constexpr ProbeLoad kNoProbe{};
constexpr Method kHalf{Integrator::kMidpointAveraging, 0.5};

double fastest_move_m(const NetMaterial& material, const StepRule& rule, int steps) {
  SpringNet net = make_net(5, material);
  SpringStepper stepper(net.rest_m.size(), net.spring.size());
  double most_m = 0.0;
  for (int i = 0; i < steps && most_m < 0.01; ++i) {
    stepper.step(net.view(), rule);
    for (std::size_t n = 0; n < net.rest_m.size(); ++n)
      most_m = std::fmax(most_m, norm(net.position_m[n] - net.rest_m[n]));
  }
  return std::isfinite(net.energy_J()) ? most_m : std::numeric_limits<double>::infinity();
}

TEST(SpringStepCheck, MatchesPenAndPaper) {
  // One node of 2 g on an anchor of 50 N/m and springs of 150 N/m to fixed nodes: omega 316.2
  // rad/s.
  SpringNet net = make_net(1, {.stiffness_N_per_m = 75.0, .anchor_N_per_m = 50.0});
  net.inverse_mass_per_kg = {0.0, 500.0, 0.0, 0.0};
  const StepLimit limit = step_limit(net.view(), kHalf, kNoProbe);
  EXPECT_NEAR(limit.omega_radps, std::sqrt(200.0 / 0.002), 1e-9);
  EXPECT_EQ(limit.fastest_node, 1u);
  EXPECT_NEAR(limit.step_s, 0.8 * 2.0 / limit.omega_radps, 1e-12);
  // a moving neighbour counts twice, a probe once
  net.inverse_mass_per_kg[0] = 1e-9;
  EXPECT_NEAR(step_limit(net.view(), kHalf, kNoProbe).omega_radps, std::sqrt(275.0 / 0.002), 1e-9);
  net.inverse_mass_per_kg[3] = 1e-9;
  EXPECT_NEAR(step_limit(net.view(), kHalf, kNoProbe).omega_radps, std::sqrt(350.0 / 0.002), 1e-9);
  EXPECT_NEAR(step_limit(net.view(), kHalf, {.stiffness_N_per_m = 100.0}).omega_radps,
              std::sqrt(450.0 / 0.002), 1e-9);
}

// With h = 1 ms and damping ratios up to 1/2 the source allows about 1400 rad/s.
TEST(SpringStepCheck, AllowsWhatTheSourceSays) {
  SpringNet net = make_net(1, {.stiffness_N_per_m = 0.0, .anchor_N_per_m = 1.0});
  for (const double omega : {1300.0, 1700.0}) {
    net.inverse_mass_per_kg = {0.0, omega * omega, 0.0, 0.0};
    net.drag_Ns_per_m.assign(4, 1.0 / omega);  // zeta 1/2
    EXPECT_EQ(check_step(net.view(), {.method = kHalf, .step_s = 0.001}, kNoProbe).has_value(),
              omega > 1600.0);
  }
}

TEST(SpringStepCheck, RefusesWhatBlowsUpAndAcceptsWhatStaysBounded) {
  for (const auto& entry : kIntegratorNames) {
    for (const double alpha : {0.375, 0.5, 0.625}) {
      for (const double tau_s : {0.0, 0.0002, 0.002, 0.02}) {
        if (alpha != 0.5 && entry.integrator != Integrator::kMidpointAveraging) continue;
        const Method method{entry.integrator, alpha};
        NetMaterial material{
            .damping_Ns_per_m = 50.0 * tau_s, .drag_Ns_per_m = 5.0 * tau_s, .shake_m = 1e-4};
        SpringNet net = make_net(5, material);
        const double limit_s = step_limit(net.view(), method, kNoProbe).step_s;
        if (limit_s > 0.0) {
          const double step_s = std::fmin(limit_s, 0.1);
          EXPECT_FALSE(check_step(net.view(), {method, step_s}, kNoProbe));
          EXPECT_LT(fastest_move_m(material, {method, step_s}, 500), 10e-4)
              << entry.name << ' ' << alpha << ' ' << tau_s;
        }
        if (std::isinf(limit_s)) continue;
        // the bound of the fastest mode is up to 2 above its real speed
        const double beyond_s = limit_s > 0.0 ? 3.0 * limit_s : 0.001;
        EXPECT_TRUE(check_step(net.view(), {method, beyond_s}, kNoProbe));
        if (limit_s == 0.0) continue;
        EXPECT_GT(fastest_move_m(material, {method, beyond_s}, 1500), 10e-4)
            << entry.name << ' ' << alpha << ' ' << tau_s;
      }
    }
  }
}

TEST(SpringStepCheck, SaysWhatToChange) {
  SpringNet net = make_net(4, {.mass_kg = 1e-4});
  const auto error = check_step(net.view(), {.method = kHalf, .step_s = 0.001}, kNoProbe);
  ASSERT_TRUE(error);
  for (const char* word : {"midpoint-averaging", "0.001 s", "rad/s", "times the mass", "substeps"})
    EXPECT_NE(error->message.find(word), std::string::npos) << error->message;
  // and the advice holds
  const auto at = error->message.find("substeps, ") + 10;
  SpringNet heavy = make_net(4, {.mass_kg = 1e-4 * std::stod(error->message.substr(at)) * 1.01});
  EXPECT_FALSE(check_step(heavy.view(), {.method = kHalf, .step_s = 0.001}, kNoProbe));
  const auto never = check_step(net.view(), {{Integrator::kRk2}, 0.001}, kNoProbe);
  ASSERT_TRUE(never);
  EXPECT_NE(never->message.find("add damping"), std::string::npos) << never->message;
  EXPECT_TRUE(check_step(net.view(), {kHalf, std::nan("")}, kNoProbe));
  EXPECT_TRUE(check_step(net.view(), {{Integrator::kImplicitEuler}, 0.0}, kNoProbe));
}

}  // namespace tact::model::springs::spring_step_check_test
