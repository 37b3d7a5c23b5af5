// SPDX-License-Identifier: Apache-2.0
#include "model/springs/spring_patch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <vector>

#include "tests/model/springs/patch_fixture.h"
#include "tests/support/no_alloc.h"

namespace tact::model::springs::spring_patch_test {

using tests::PressedPatch;
using tests::soft_patch;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The force after the patch has come to rest.
double settled_N(PressedPatch& pressed, double depth_m, bool held = false) {
  double force_N = 0.0;
  for (int i = 0; i < 800; ++i) {
    force_N = pressed.move_to(0.001, 0.002, depth_m, held).law.force_N;
    pressed.advance();
  }
  EXPECT_LT(pressed.patch().kinetic_energy_J(), 1e-12);
  return force_N;
}

TEST(SpringPatch, MatchesPenAndPaper) {
  // Stiff tissue alone: the first tick gives the coupling, 300 N/m * 2 mm.
  PressedPatch pressed(soft_patch());
  const contact::ContactLawResponse first = pressed.move_to(0.0, 0.0, 0.002);
  EXPECT_NEAR(first.law.force_N, 0.6, 1e-12);
  EXPECT_NEAR(first.law.energy_J, 0.0006, 1e-15);
  EXPECT_NEAR(first.law.stiffness_N_per_m, 300.0, 1e-12);
  // A net whose springs carry nothing across, pressed in a vertex: body and coupling in series.
  SpringPatchParameters p = soft_patch();
  p.tissue.surface_stiffness_N_per_m = 1e-6;
  PressedPatch unlinked(p);
  double force_N = 0.0;
  for (int i = 0; i < 1500; ++i) {
    force_N = unlinked.move_to(0.0, 0.0, 0.001).law.force_N;
    unlinked.advance();
  }
  const PatchSurface& surface = unlinked.patch().region().surface();
  const double anchor = surface.anchor_N_per_m[unlinked.patch().region().vertices()[0]];
  EXPECT_NEAR(force_N, 0.001 * anchor * 300.0 / (anchor + 300.0), 1e-6);
}

TEST(SpringPatch, SettledForceIsTheSlopeOfStoredEnergy) {
  SpringPatchParameters p = soft_patch();
  p.tissue.pretension_ratio = 0.05;
  PressedPatch pressed(p);
  const double step_m = 0.0005;
  double before_N = 0.0, before_J = 0.0;
  for (int i = 0; i < 8; i += 2) {
    const double middle_N = settled_N(pressed, step_m * (i + 1));
    const double force_N = settled_N(pressed, step_m * (i + 2));
    const double energy_J = pressed.patch().stored_energy_J();
    EXPECT_GT(middle_N, before_N);
    EXPECT_GT(force_N, middle_N);
    // Simpson's rule over two steps
    const double mean_N = (before_N + 4.0 * middle_N + force_N) / 6.0;
    EXPECT_NEAR((energy_J - before_J) / (2.0 * step_m), mean_N, 2e-3 * force_N);
    EXPECT_NEAR(pressed.move_to(0.001, 0.002, step_m * (i + 2)).law.energy_J, energy_J, 1e-9);
    before_N = force_N;
    before_J = energy_J;
  }
}

TEST(SpringPatch, ForceIsTheSlopeOfEnergyWithTheNodesAsTheyAre) {
  PressedPatch pressed(soft_patch());
  settled_N(pressed, 0.003);
  const double e = 1e-7;
  for (const double d : {0.002, 0.003, 0.005}) {
    const contact::ContactLawResponse here = pressed.move_to(0.0013, 0.0007, d);
    const auto energy_J = [&](double x_m, double y_m, double depth_m) {
      return pressed.move_to(x_m, y_m, depth_m).law.energy_J;
    };
    EXPECT_NEAR(here.law.force_N,
                (energy_J(0.0013, 0.0007, d + e) - energy_J(0.0013, 0.0007, d - e)) / (2 * e),
                1e-6);
    EXPECT_NEAR(here.slope_N.x,
                (energy_J(0.0013 + e, 0.0007, d) - energy_J(0.0013 - e, 0.0007, d)) / (2 * e),
                1e-6);
    EXPECT_NEAR(here.slope_N.y,
                (energy_J(0.0013, 0.0007 + e, d) - energy_J(0.0013, 0.0007 - e, d)) / (2 * e),
                1e-6);
    EXPECT_EQ(here.slope_N.z, 0.0);
  }
}

// Slow and fast, shallow and deep; trapezoid work, nodes still while the tool moves.
TEST(SpringPatch, ClosedStrokeReturnsNoEnergy) {
  for (const double rate_Hz : {1.0, 5.0, 50.0}) {
    for (const bool held : {false, true}) {
      PressedPatch pressed(soft_patch());
      double most_J = 0.0;
      const int ticks = static_cast<int>(1000.0 / rate_Hz);
      for (int stroke = 0; stroke < 3; ++stroke) {
        for (int i = 1; i <= ticks; ++i) {
          const double wave = std::sin(2.0 * std::numbers::pi * i / ticks);
          pressed.move_to(0.001, 0.002, 0.004 * wave, held);
          most_J = std::fmax(most_J, pressed.work_J());
          EXPECT_GT(pressed.work_J(), -1e-9) << rate_Hz << " Hz, tick " << i;
          pressed.advance();
        }
      }
      EXPECT_GT(most_J, 1e-5);
    }
  }
}

TEST(SpringPatch, RestStaysAtRest) {
  SpringPatchParameters p = soft_patch();
  p.tissue.pretension_ratio = 0.2;
  PressedPatch pressed(p);
  for (int i = 0; i < 500; ++i) {
    EXPECT_EQ(pressed.move_to(0.0, 0.0, 0.0, true).law.force_N, 0.0) << "held without a pull";
    pressed.advance();
    EXPECT_EQ(pressed.move_to(0.0, 0.0, 0.0, false).law.status, law::LawStatus::kNoContact);
    pressed.advance();
  }
  for (const std::uint32_t v : pressed.patch().region().vertices())
    EXPECT_LT(norm(pressed.patch().region().moved_m(v)), 1e-15);
  EXPECT_NEAR(pressed.patch().stored_energy_J(), 0.0, 1e-15);
}

TEST(SpringPatch, NeverPullsUnlessHeld) {
  PressedPatch pressed(soft_patch());
  for (int i = 0; i < 2000; ++i) {
    const double d = 0.004 * std::sin(0.3 * i) + 0.001 * std::sin(1.7 * i);
    EXPECT_GE(pressed.move_to(0.0, 0.0, d).law.force_N, 0.0);
    pressed.advance();
  }
  PressedPatch pulled(soft_patch());
  EXPECT_LT(settled_N(pulled, -0.003, true), -0.05);
  pulled.patch().leave(0);
  pulled.advance(3000);
  EXPECT_LT(pulled.patch().stored_energy_J(), 1e-12) << "let go, it comes back";
}

TEST(SpringPatch, SaturatesBeyondItsWorkingDepth) {
  PressedPatch pressed(soft_patch());
  const contact::ContactLawResponse limit = pressed.move_to(0.0, 0.0, 0.01);
  const contact::ContactLawResponse beyond = pressed.move_to(0.0, 0.0, 0.5);
  EXPECT_EQ(beyond.law.status, law::LawStatus::kSaturated);
  EXPECT_EQ(beyond.law.force_N, limit.law.force_N);
  EXPECT_NEAR(beyond.law.energy_J, limit.law.energy_J + 0.49 * limit.law.force_N, 1e-12);
}

TEST(SpringPatch, NonFiniteInputIsRefusedAndThePatchGoesOn) {
  PressedPatch pressed(soft_patch());
  settled_N(pressed, 0.003);
  SpringPatch& patch = pressed.patch();
  const contact::SurfacePoint good{420, {0.2, 0.3, 0.5}};
  const auto refused = [&patch](const contact::Indentation& in) {
    const contact::ContactLawResponse r = patch.respond(in);
    patch.advance();
    return r.law.status == law::LawStatus::kInvalid && r.law.force_N == 0.0 && r.slope_N == Vec3{};
  };
  EXPECT_TRUE(refused({.surface_point = good, .indentation_m = kNaN}));
  EXPECT_TRUE(
      refused({.surface_point = good, .indentation_m = std::numeric_limits<double>::infinity()}));
  EXPECT_TRUE(refused({.surface_point = {}, .indentation_m = 0.001}));
  EXPECT_TRUE(refused({.surface_point = {420, {kNaN, 0.5, 0.5}}, .indentation_m = 0.001}));
  EXPECT_TRUE(
      refused({.sphere = contact::kMaxSpheres, .surface_point = good, .indentation_m = 0.001}));
  const contact::ContactLawResponse r =
      patch.respond({.surface_point = good, .indentation_m = 0.001});
  EXPECT_EQ(r.law.status, law::LawStatus::kOk);
  EXPECT_TRUE(std::isfinite(r.law.force_N));
}

TEST(SpringPatch, FourSpheresPressAtOnce) {
  SpringPatchParameters p = soft_patch();
  p.spheres = 4;
  p.node_mass_kg = 0.004;
  PressedPatch pressed(p);
  std::array<double, 4> force_N{};
  for (int i = 0; i < 2000; ++i) {
    for (std::uint32_t s = 0; s < 4; ++s)
      force_N[s] = pressed.patch()
                       .respond({.sphere = s,
                                 .surface_point = {300 + 40 * s, {0.3, 0.3, 0.4}},
                                 .indentation_m = 0.002})
                       .law.force_N;
    pressed.advance();
  }
  const double alone_N = settled_N(*std::make_unique<PressedPatch>(p), 0.002);
  for (const double f : force_N) {
    EXPECT_GT(f, 0.0);
    EXPECT_LT(f, alone_N) << "a neighbour's indentation leaves less to press";
  }
}

TEST(SpringPatch, EveryIntegratorGivesTheSameSettledForce) {
  std::vector<double> force_N;
  for (const auto& entry : kIntegratorNames) {
    SpringPatchParameters p = soft_patch();
    p.method.integrator = entry.integrator;
    p.substeps = 2;  // explicit Euler needs it
    PressedPatch pressed(p);
    force_N.push_back(settled_N(pressed, 0.003));
    EXPECT_NEAR(force_N.back() / force_N[0], 1.0, 1e-5) << entry.name;
  }
}

TEST(SpringPatch, UsesAsManyNodesOnALargeMeshAsOnASmallOne) {
  std::set<std::size_t> nodes, springs;
  for (const std::uint32_t cells : {20u, 40u, 120u}) {
    SpringPatchParameters p = soft_patch();
    p.node_mass_kg = 0.01;
    PressedPatch pressed(p, cells);
    const contact::SurfacePoint middle{cells * cells + cells, {0.3, 0.3, 0.4}};
    pressed.patch().respond({.surface_point = middle, .indentation_m = 0.001});
    pressed.advance();
    nodes.insert(pressed.patch().region().vertices().size());
    springs.insert(pressed.patch().region().spring_count());
  }
  EXPECT_EQ(nodes, std::set<std::size_t>{120});
  EXPECT_EQ(springs.size(), 1u);
}

TEST(SpringPatch, LeavesTheHeapAlone) {
  SpringPatchParameters p = soft_patch();
  p.nodes = 100;
  PressedPatch pressed(p);
  SpringPatch& patch = pressed.patch();
  contact::PatchShape shape;
  const tests::NoAlloc guard;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const contact::SurfacePoint surface_point{200 + 2 * i, {0.3, 0.3, 0.4}};
    patch.respond({.surface_point = surface_point, .indentation_m = 0.002});
    patch.cut({{-0.05, 0.0, -0.01}, {-0.05, 0.0, 0.01}, {0.05, 0.0, -0.01}, {0.05, 0.0, 0.01}});
    patch.advance();
    patch.shape(shape);
    if (i % 100 == 99) patch.leave(0);
  }
  EXPECT_EQ(guard.calls(), 0u);
}

TEST(SpringPatch, SaysWhatIsWrongWithItsParameters) {
  const tests::PressedPatch pressed(soft_patch());
  const auto message = [&pressed](const std::function<void(SpringPatchParameters&)>& change) {
    SpringPatchParameters p = soft_patch();
    change(p);
    const auto made = make_spring_patch(pressed.mesh().view(), p);
    return made ? std::string() : made.error().message;
  };
  const auto names = [&](const char* word,
                         const std::function<void(SpringPatchParameters&)>& change) {
    EXPECT_NE(message(change).find(word), std::string::npos) << word << ": " << message(change);
  };
  EXPECT_EQ(message([](auto&) {}), "");
  names("surface_stiffness", [](auto& p) { p.tissue.surface_stiffness_N_per_m = 0.0; });
  names("body_stiffness", [](auto& p) { p.tissue.body_stiffness_N_per_m = kNaN; });
  names("damping_time", [](auto& p) { p.tissue.damping_time_s = -1.0; });
  names("body_damping", [](auto& p) { p.tissue.body_damping_time_s = kNaN; });
  names("pretension", [](auto& p) { p.tissue.pretension_ratio = 0.6; });
  names("coupling", [](auto& p) { p.coupling_stiffness_N_per_m = 0.0; });
  names("node_mass", [](auto& p) { p.node_mass_kg = 0.0; });
  names("working_depth", [](auto& p) { p.working_depth_m = 0.0; });
  names("tick_s", [](auto& p) { p.tick_s = 0.0; });
  names("spheres", [](auto& p) { p.spheres = contact::kMaxSpheres + 1; });
  names("nodes", [](auto& p) { p.nodes = 2000; });
  names("alpha", [](auto& p) { p.method.alpha = 0.0; });
  names("iterations", [](auto& p) { p.iterations = 0; });
  names("substeps", [](auto& p) { p.substeps = 0; });
  names("times the mass", [](auto& p) { p.node_mass_kg = 0.0002; });
  names("rad/s", [](auto& p) { p.coupling_stiffness_N_per_m = 5000.0; });
}

}  // namespace tact::model::springs::spring_patch_test
