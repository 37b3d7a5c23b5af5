// SPDX-License-Identifier: Apache-2.0
// Relaxation of a spring patch: it fades as its terms say, and never makes energy.
#include "model/springs/patch_memory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/scene/tissue_law.h"
#include "model/springs/spring_patch.h"
#include "tests/model/springs/patch_fixture.h"
#include "tests/model/springs/spring_mesh.h"
#include "tests/support/no_alloc.h"

namespace tact::model::springs::patch_memory_test {

using tests::PressedPatch;
using tests::soft_patch;

constexpr double kTick_s = 0.001;
constexpr double kShallow_m = 1e-5;  // a flat net is a cubic spring across: linear only here

law::Relaxation relaxation(const std::vector<law::PronyTerm>& terms) {
  return *make_relaxation(terms, kTick_s);
}

SpringPatchParameters fading_patch(const std::vector<law::PronyTerm>& terms) {
  SpringPatchParameters p = soft_patch();
  p.relaxation = relaxation(terms);
  return p;
}

/// A coupling far stiffer than the tissue: the tool holds the surface itself.
SpringPatchParameters stiffly_coupled(const std::vector<law::PronyTerm>& terms) {
  SpringPatchParameters p = fading_patch(terms);
  p.method.integrator = Integrator::kImplicitEuler;
  p.iterations = 30;
  p.nodes = 60;
  p.coupling_stiffness_N_per_m = 20000.0;
  return p;
}

/// Forces at one held depth, every tick.
std::vector<double> held_N(const SpringPatchParameters& p, double depth_m, int ticks) {
  PressedPatch pressed(p);
  std::vector<double> force_N;
  for (int i = 0; i < ticks; ++i) {
    force_N.push_back(pressed.move_to(0.001, 0.002, depth_m).law.force_N);
    pressed.advance();
  }
  return force_N;
}

double noise(std::uint32_t& seed) {  // -1 .. 1, the same everywhere
  seed = seed * 1664525u + 1013904223u;
  return static_cast<double>(seed >> 8) / 8388608.0 - 1.0;
}

TEST(PatchMemory, MatchesPenAndPaper) {
  // Half stays, half has 1 ms to forget: after a step of 1 mm and one tick, e = exp(-1) mm.
  PatchMemory memory(relaxation({{0.5, kTick_s}}), 4);
  tests::SpringNet net = tests::make_net(1, {});
  for (std::size_t i = 0; i < 4; ++i) memory.forget(i, net.rest_m[i]);
  memory.renew(net.view(), net.position_m);
  memory.relaxed_rest_m(4)[1].z += 0.001;
  memory.flow(net.position_m, net.rest_m);
  EXPECT_NEAR(net.position_m[1].z, 0.001, 1e-15);
  const double relaxed_rest_m = 0.001 * (0.5 + 0.5 * std::exp(-1.0));
  EXPECT_NEAR(memory.relaxed_rest_m(4)[1].z, relaxed_rest_m, 1e-15);
  EXPECT_NEAR(memory.flowed_m(1, net.position_m[1]).z, 0.001 - relaxed_rest_m, 1e-15);
  EXPECT_EQ(memory.relaxed_rest_m(4)[2], net.rest_m[2]) << "rest stays rest, to the last bit";
  // only anchors, 5 N/m: W = 0.5 * 5/2 * 1 mm^2 + 0.5 * 5/2 * (1 mm / e)^2
  net.spring.clear();
  SpringNetwork network = net.view();
  const double expected_J = 1.25e-6 * (1.0 + std::exp(-2.0));
  EXPECT_NEAR(memory.stored_energy_J(network, net.position_m), expected_J, 1e-18);
}

TEST(PatchMemory, StifflyCoupledPatchFadesAsItsTermsSay) {
  const double elastic_N = held_N(stiffly_coupled({}), kShallow_m, 600).back();
  const std::vector<law::PronyTerm> terms{{0.3, 0.1}, {0.4, 1.0}};
  const std::vector<double> force_N = held_N(stiffly_coupled(terms), kShallow_m, 1501);
  for (const int tick : {250, 400, 600, 1000, 1500}) {
    const double t_s = tick * kTick_s;
    const double left = 0.3 + 0.3 * std::exp(-t_s / 0.1) + 0.4 * std::exp(-t_s / 1.0);
    EXPECT_NEAR(force_N[static_cast<std::size_t>(tick)] / elastic_N, left, 0.005) << t_s;
  }
}

TEST(PatchMemory, EveryIntegratorEndsAtTheForceThatStays) {
  for (const auto& entry : kIntegratorNames) {
    SpringPatchParameters fading = fading_patch({{0.5, 0.02}}), soft = soft_patch();
    // what stays is a patch of half the stiffness
    soft.tissue.surface_stiffness_N_per_m *= 0.5;
    soft.tissue.body_stiffness_N_per_m *= 0.5;
    for (SpringPatchParameters* p : {&fading, &soft})
      p->method.integrator = entry.integrator, p->substeps = 2, p->nodes = 40;
    const double now_N = held_N(fading, kShallow_m, 600).back();
    EXPECT_NEAR(now_N / held_N(soft, kShallow_m, 600).back(), 1.0, 0.002) << entry.name;
  }
}

// Any path of the tool along the surface and into it, 3 mm deep: what is stored and moves is never
// more than what the hand gave.
void expect_passive(double stride_m, bool held, std::uint32_t seed) {
  PressedPatch pressed(fading_patch({{0.4, 0.02}, {0.3, 0.2}}));
  SpringPatch& patch = pressed.patch();
  std::uint32_t chance = seed;
  double x_m = 0.001, y_m = 0.002, d_m = 0.0, most_J = 0.0;
  // held: rounding; else the trapezoid misses where in a tick the tool lets go, about q dd^2 / 8
  const double error_J = held ? 1e-12 : 2e-6;
  for (int i = 0; i < 1200; ++i) {
    x_m += stride_m * noise(chance);
    y_m += stride_m * noise(chance);
    d_m = 0.98 * d_m + 0.001 * noise(chance);
    pressed.move_to(x_m, y_m, d_m, held);
    pressed.advance();
    most_J = std::fmax(most_J, pressed.work_J());
    const double kept_J = patch.stored_energy_J() + patch.kinetic_energy_J();
    ASSERT_LE(kept_J, pressed.work_J() + patch.region().energy_deficit_J() + error_J)
        << seed << ", tick " << i;
  }
  EXPECT_GT(most_J, 1e-3);
  EXPECT_LT(patch.region().energy_deficit_J(), 1e-4 * most_J);
}

TEST(PatchMemory, PassiveOverRandomStrokes) {
  for (const double stride_m : {0.0002, 0.001})  // in one region, and from region to region
    for (std::uint32_t seed = 1; seed <= 3; ++seed)
      for (const bool held : {false, true}) expect_passive(stride_m, held, seed);
}

TEST(PatchMemory, EnergyFallsWhileTheDepthIsHeld) {
  PressedPatch pressed(stiffly_coupled({{0.5, 0.1}}));
  const auto tick = [&pressed] {
    pressed.move_to(0.001, 0.002, kShallow_m);
    pressed.advance();
    return pressed.patch().stored_energy_J() + pressed.patch().kinetic_energy_J();
  };
  double before_J = 0.0, first_J = 0.0;
  for (int i = 0; i < 30; ++i) first_J = before_J = tick();
  for (int i = 0; i < 600; ++i) {
    const double now_J = tick();
    ASSERT_LE(now_J, before_J * (1.0 + 1e-9)) << i;
    before_J = now_J;
  }
  EXPECT_LT(before_J, 0.8 * first_J);
}

TEST(PatchMemory, CuttingOnlyRemovesEnergyAndThenTheLipsCreepApart) {
  SpringPatchParameters p = fading_patch({{0.5, 0.3}});
  p.tissue.pretension_ratio = 0.15;
  PressedPatch pressed(p);
  SpringPatch& patch = pressed.patch();
  const auto settle = [&pressed](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      pressed.move_to(0.001, 0.0024, 0.003);
      pressed.advance();
    }
  };
  settle(500);
  for (int i = 0; i < 20; ++i) {
    const double before_J = patch.stored_energy_J(), moving_J = patch.kinetic_energy_J();
    const double x_m = -0.02 + 0.002 * i;
    patch.cut({{x_m, 0.0024, -0.01},
               {x_m, 0.0024, 0.01},
               {x_m + 0.002, 0.0024, -0.01},
               {x_m + 0.002, 0.0024, 0.01}});
    EXPECT_LE(patch.stored_energy_J(), before_J);
    EXPECT_EQ(patch.kinetic_energy_J(), moving_J);
    settle(5);
  }
  ASSERT_GT(patch.region().cut_triangles().size(), 10u);
  const auto energy_J = [&patch] { return patch.stored_energy_J() + patch.kinetic_energy_J(); };
  const auto gap_m = [&patch] {
    double sum_m = 0.0;
    for (const std::uint32_t v : patch.region().cut_edges())
      sum_m += std::abs(patch.region().moved_m(v).y);
    return sum_m;
  };
  patch.leave(0);
  patch.advance(), patch.advance();
  for (int i = 0; i < 60; ++i) patch.advance();
  const double gap_then_m = gap_m();
  double before_J = energy_J();
  for (int i = 0; i < 20; ++i) {
    for (int k = 0; k < 50; ++k) patch.advance();
    EXPECT_LE(energy_J(), before_J + 1e-12) << i;
    before_J = energy_J();
  }
  EXPECT_GT(gap_m(), 1.2 * gap_then_m);
}

TEST(PatchMemory, LeavingToolGainsNoEnergyAndThePatchForgets) {
  SpringPatchParameters p = fading_patch({{0.4, 0.05}, {0.3, 0.5}});
  p.nodes = 60;
  PressedPatch pressed(p);
  for (int i = 0; i < 2000; ++i) {
    pressed.move_to(-0.03 + 0.00003 * i, 0.0024, 0.002);
    pressed.advance();
  }
  SpringPatch& patch = pressed.patch();
  EXPECT_GT(pressed.work_J() + patch.region().energy_deficit_J(), patch.stored_energy_J());
  EXPECT_LT(patch.region().energy_deficit_J(), 0.1 * pressed.work_J());
  patch.leave(0);
  for (int i = 0; i < 6000; ++i) patch.advance();
  EXPECT_LT(patch.stored_energy_J(), 1e-9) << "let go, it comes back";
}

TEST(PatchMemory, ASceneThatFadesMakesAPatchThatFades) {
  scene::Scene scene;
  scene.rate_Hz = 1000.0;
  scene.laws.of<springs::SpringPatchParameters>() = stiffly_coupled({});
  scene.organ_mesh = tests::make_plate(0.1, 20);
  scene.tool.spheres = {{{}, 0.004}};
  scene.relaxation = {{0.5, 0.01}};
  const auto made = make_tissue_law(scene, "spring_patch");
  ASSERT_TRUE(made) << made.error().message;
  contact::ContactLaw& law = (*made)->contact_law();
  std::vector<double> force_N;
  for (int i = 0; i < 300; ++i) {
    force_N.push_back(
        law.respond({.surface_point = {420, {0.3, 0.3, 0.4}}, .indentation_m = kShallow_m})
            .law.force_N);
    law.advance();
  }
  scene.relaxation.clear();
  const auto elastic = make_tissue_law(scene, "spring_patch");
  double elastic_N = 0.0;
  for (int i = 0; i < 300; ++i) {
    elastic_N = (*elastic)
                    ->contact_law()
                    .respond({.surface_point = {420, {0.3, 0.3, 0.4}}, .indentation_m = kShallow_m})
                    .law.force_N;
    (*elastic)->contact_law().advance();
  }
  EXPECT_NEAR(force_N.back() / elastic_N, 0.5, 0.01);
  scene.relaxation = {{1.5, 0.01}};
  EXPECT_FALSE(make_tissue_law(scene, "spring_patch"));
}

TEST(PatchMemory, WithoutTermsNothingIsKept) {
  PatchMemory memory({}, 500);
  EXPECT_FALSE(memory.is_on());
  EXPECT_EQ(memory.memory_bytes(), 0u);
}

TEST(PatchMemory, LeavesTheHeapAlone) {
  PressedPatch pressed(fading_patch({{0.3, 0.1}, {0.3, 0.1}, {0.3, 0.1}}));
  SpringPatch& patch = pressed.patch();
  const tests::NoAlloc guard;
  for (std::uint32_t i = 0; i < 200; ++i) {
    patch.respond({.surface_point = {200 + 2 * i, {0.3, 0.3, 0.4}}, .indentation_m = 0.002});
    patch.cut({{-0.05, 0, -0.01}, {-0.05, 0, 0.01}, {0.05, 0, -0.01}, {0.05, 0, 0.01}});
    patch.advance();
  }
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::model::springs::patch_memory_test
