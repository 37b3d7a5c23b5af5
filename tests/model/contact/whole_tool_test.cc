// SPDX-License-Identifier: Apache-2.0
// Several spheres on one tool, as a hand moves them: no stroke gives back more than it took.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "model/contact/contact.h"
#include "model/units.h"
#include "tests/support/no_alloc.h"
#include "tests/support/shapes.h"
#include "tests/support/soft_half_space.h"

namespace tact::model::contact::whole_tool_test {

constexpr double kRadius_m = 4_mm;

/// A soft half-space below tools of two to four spheres.
struct Bench {
  explicit Bench(std::vector<ProbeSphere> s, mesh::SurfaceMesh m = tests::make_plate(160_mm, 32))
      : mesh(std::move(m)), spheres(std::move(s)) {}
  Contact contact() {
    return Contact({.law = &tissue.field,
                    .parameters = parameters,
                    .spheres = spheres,
                    .surface = mesh.view(),
                    .tree = tree.view(),
                    .blade = {}});
  }
  tests::SoftHalfSpace tissue;
  mesh::SurfaceMesh mesh;
  TriangleTree tree = make_triangle_tree(mesh.view());
  std::vector<ProbeSphere> spheres;
  ContactParameters parameters{
      .friction_ratio = 0.4, .sliding_stiffness_N_per_m = 20.0, .tear_force_N = 0.3};
};

std::vector<ProbeSphere> jaws(std::size_t count) {
  std::vector<ProbeSphere> all{{{0, -4_mm, 0}, kRadius_m},
                               {{0, 4_mm, 0}, kRadius_m},
                               {{8_mm, 0, 1_mm}, kRadius_m},
                               {{-8_mm, 0, -1_mm}, kRadius_m}};
  all.resize(count);
  return all;
}

Wrench render_at(Contact& contact, const Tool& tool) {
  contact.detect_contact(tool);
  return contact.render_force(tool, false).wrench;
}

double energy_J(const Contact& contact) {
  double sum = 0.0;
  for (const SphereContact& sphere_contact : contact.contacts()) sum += sphere_contact.energy_J;
  return sum;
}

/// A smooth closed stroke: the tool sinks, moves about, turns, and comes back.
struct Stroke {
  double deep_m = 0.0, across_m = 0.0, along_m = 0.0, turn_rad = 0.0, grip_from = 2.0,
         grip_to = 2.0;

  Tool at(double share) const {
    const double p = 2.0 * std::numbers::pi * share, turn = turn_rad * std::sin(p);
    return {.position_m = {across_m * std::sin(2 * p), along_m * std::sin(p),
                           kRadius_m + 2_mm - deep_m * (1 - std::cos(p)) / 2},
            .orientation = {std::cos(turn / 2), std::sin(turn / 2), 0, 0},
            .grip_ratio = share > grip_from && share < grip_to ? 1.0 : 0.0};
  }
};

Stroke random_stroke(std::mt19937& random, double grips) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  Stroke stroke{.deep_m = 2_mm + 10_mm * share(random),
                .across_m = 6_mm * share(random),
                .along_m = 6_mm * share(random),
                .turn_rad = 0.4 * share(random)};
  if (share(random) < grips) {
    stroke.grip_from = 0.1 + 0.5 * share(random);
    stroke.grip_to = stroke.grip_from + 0.35 * share(random);
  }
  return stroke;
}

/// Work that the tool does on the hand, J, beside what is stored at the end; < 0: the hand gave it.
double given_energy_J(Contact& contact, const Stroke& stroke, int ticks) {
  Tool before = stroke.at(0.0);
  Wrench rendered_before = render_at(contact, before);
  double work_J = 0.0;
  for (int i = 1; i <= ticks; ++i) {
    const Tool tool = stroke.at(static_cast<double>(i) / ticks);
    const Wrench rendered = render_at(contact, tool);
    const double turned_rad =
        2.0 * (std::asin(tool.orientation.x) - std::asin(before.orientation.x));
    work_J +=
        0.5 * dot(rendered.force_N + rendered_before.force_N, tool.position_m - before.position_m) +
        0.5 * (rendered.torque_Nm.x + rendered_before.torque_Nm.x) * turned_rad;
    before = tool;
    rendered_before = rendered;
  }
  return work_J + energy_J(contact);
}

TEST(WholeTool, NoStrokeGivesBackMoreThanItTook) {
  std::mt19937 random(11);
  double most_lost_J = 0.0;
  for (int k = 0; k < 60; ++k) {
    Bench bench(jaws(2 + static_cast<std::size_t>(k) % 3));
    if (k % 2 == 0) bench.parameters.sliding_stiffness_N_per_m = 0.0;  // the tissue's own
    Contact contact = bench.contact();
    const double given = given_energy_J(contact, random_stroke(random, 0.7), 4000);
    EXPECT_LE(given, 2e-8) << "stroke " << k;
    most_lost_J = std::min(most_lost_J, given);
  }
  EXPECT_LT(most_lost_J, -1e-5) << "rubbing and tearing cost energy";
}

// Two jaws of eight spheres each, 28 mm long.
std::vector<ProbeSphere> grasper() {
  std::vector<ProbeSphere> all;
  for (int i = 0; i < 16; ++i)
    all.push_back({{(i / 2 - 3.5) * 4_mm, i % 2 == 0 ? -4_mm : 4_mm, 0}, kRadius_m});
  return all;
}

TEST(WholeTool, AStrokeOfSixteenSpheresGivesBackNoMoreThanItTook) {
  std::mt19937 random(17);
  for (int k = 0; k < 4; ++k) {
    Bench bench(grasper());
    bench.parameters.sliding_stiffness_N_per_m = k % 2 == 0 ? 20.0 : 0.0;
    Contact contact = bench.contact();
    EXPECT_LE(given_energy_J(contact, random_stroke(random, 0.5), 4000), 1e-7) << k;
  }
}

TEST(WholeTool, WithoutFrictionAStrokeReturnsAll) {
  std::mt19937 random(12);
  for (int k = 0; k < 30; ++k) {
    Bench bench(jaws(2 + static_cast<std::size_t>(k) % 3));
    bench.parameters.friction_ratio = 0.0;
    Contact contact = bench.contact();
    EXPECT_NEAR(given_energy_J(contact, random_stroke(random, 0.0), 4000), 0.0, 2e-8)
        << "stroke " << k;
  }
}

TEST(WholeTool, NoStrokeThroughTissueThatRelaxesGivesBackMoreThanItTook) {
  const std::vector<law::PronyTerm> terms{{.share = 0.3, .time_s = 0.2},
                                          {.share = 0.4, .time_s = 2.0}};
  std::mt19937 random(16);
  double most_lost_J = 0.0;
  for (int k = 0; k < 60; ++k) {
    Bench bench(jaws(2 + static_cast<std::size_t>(k) % 3));
    if (k % 2 == 0) bench.parameters.friction_ratio = 0.0;
    const double modulus_Pa = bench.tissue.tip.contact_modulus_Pa();
    bench.tissue.field = tissue::ElasticField(
        {.curves = {&bench.tissue.law, 1},
         .coordinate = {},
         .pull_coordinate = {},
         .surface = {},
         .relaxation = *make_relaxation(terms, 0.001),
         .neighbours = {.contact_modulus_Pa = modulus_Pa, .poisson_ratio = 0.45}});
    Contact contact = bench.contact();
    const double given = given_energy_J(contact, random_stroke(random, 0.5), 4000);
    EXPECT_LE(given, 2e-8) << "stroke " << k;
    most_lost_J = std::min(most_lost_J, given);
  }
  EXPECT_LT(most_lost_J, -1e-5) << "what relaxes is lost";
}

TEST(WholeTool, LettingGoNeverAddsEnergy) {
  std::mt19937 random(13);
  for (int k = 0; k < 100; ++k) {
    Bench bench(jaws(2 + static_cast<std::size_t>(k) % 3), tests::make_ball(50_mm, 5));
    bench.parameters.tear_force_N = 100.0;
    if (k % 2 == 0) bench.parameters.sliding_stiffness_N_per_m = 0.0;
    Contact contact = bench.contact();
    Stroke stroke = random_stroke(random, 0.0);
    stroke.grip_from = 0.3, stroke.grip_to = 0.45 + 0.004 * k;
    double before_J = 0.0;
    for (int i = 0; i <= 1000; ++i) {
      Tool tool = stroke.at(i / 1000.0);
      tool.position_m.z += 50_mm;
      const bool was_held = contact.contacts()[0].state == ContactState::kHeld;
      // Opened in place: only the state changes.
      if (was_held && tool.grip_ratio == 0.0) {
        Tool still = stroke.at((i - 1) / 1000.0);
        still.position_m.z += 50_mm;
        still.grip_ratio = 0.0;
        render_at(contact, still);
        EXPECT_LE(energy_J(contact), before_J + 1e-12) << "stroke " << k;
        break;
      }
      render_at(contact, tool);
      before_J = energy_J(contact);
    }
  }
}

TEST(WholeTool, SidewaysThePairIsSofterThanTheSumOfEach) {
  const auto stiffness_N_per_m = [](std::size_t count) {
    Bench bench(jaws(count));
    bench.parameters.friction_ratio = 10.0;
    Contact contact = bench.contact();
    Tool tool{.position_m = {0, 0, kRadius_m + 1_mm}};
    for (int i = 0; i <= 100; ++i) {
      tool.position_m.z = kRadius_m + 1_mm - 5_mm * i / 100;
      render_at(contact, tool);
    }
    tool.position_m.x += 0.5_mm;
    return -render_at(contact, tool).force_N.x / 0.5_mm;
  };
  // MC-4 by hand: each jaw carries t / (1 / k_t + C)
  const double c = 1.0 / (std::numbers::pi * Bench(jaws(2)).tissue.tip.contact_modulus_Pa() * 8_mm);
  EXPECT_NEAR(stiffness_N_per_m(1), 20.0, 1e-9);
  EXPECT_NEAR(stiffness_N_per_m(2), 2.0 / (1.0 / 20.0 + c), 1e-6);
}

TEST(WholeTool, FrictionOfEachJawStaysInItsCone) {
  std::mt19937 random(14);
  for (int k = 0; k < 20; ++k) {
    Bench bench(jaws(4));
    Contact contact = bench.contact();
    const Stroke stroke = random_stroke(random, 0.0);
    for (int i = 0; i <= 2000; ++i) {
      render_at(contact, stroke.at(i / 2000.0));
      for (const SphereContact& sphere_contact : contact.contacts()) {
        const double normal_N = dot(sphere_contact.force_N, sphere_contact.normal);
        ASSERT_LE(norm(tangential(sphere_contact.force_N, sphere_contact.normal)),
                  0.4 * normal_N * 1.02 + 1e-6);
      }
    }
  }
}

// What is left of an excess would slip in the next tick, even with a tool at rest.
TEST(WholeTool, SlipOfCoupledSpheresSettlesInOneTick) {
  std::mt19937 random(16);
  double changed_ratio = 0.0;
  for (int k = 0; k < 6; ++k) {
    Bench bench(jaws(4));
    bench.parameters.sliding_stiffness_N_per_m = 0.0;  // that of the tissue
    Contact contact = bench.contact();
    const Stroke stroke = random_stroke(random, 0.0);
    for (int i = 0; i <= 2000; ++i) {
      const Vec3 moving_N = render_at(contact, stroke.at(i / 2000.0)).force_N;
      const Vec3 resting_N = render_at(contact, stroke.at(i / 2000.0)).force_N;
      changed_ratio = std::max(changed_ratio, norm(resting_N - moving_N) / (norm(moving_N) + 0.01));
    }
  }
  EXPECT_LT(changed_ratio, 1e-5);
}

TEST(WholeTool, APinchedLobeIsDraggedTheSameWayOnBothSides) {
  Bench bench(jaws(2));
  const Indentation top{.sphere = 0, .normal = {0, 0, 1}}, below{.sphere = 1, .normal = {0, 0, -1}};
  const double c = bench.tissue.field.coupling(top, below, 24_mm).near_field_m_per_N;
  const Axes of_top = axes_of(top.normal),
             of_below = axes_of(below.normal, {{Vec3{0.6, 0.8, 0}, Vec3{}}});
  const OwnCompliance own{.m_per_N = {1.0 / 20.0, 0.0, 1.0 / 20.0}, .least_m_per_N = 1.0 / 20.0};
  Shear shear;
  shear.set_own(0, own);
  shear.set_own(1, own);
  shear.couple(0, 1, c, of_top, of_below);
  shear.solve();
  const Vec3 moved_m{1_mm, 0, 0};
  const Vec3 together_N =
      of_top.vector(shear.force_N({of_top.of(moved_m), of_below.of(moved_m)}, 0));
  EXPECT_GT(c, 0.0);
  EXPECT_NEAR(together_N.x, 1_mm / (1.0 / 20.0 + c), 1e-12);
  EXPECT_NEAR(together_N.y, 0.0, 1e-12);
}

TEST(WholeTool, RepeatsAStrokeToTheBitAndLeavesTheHeapAlone) {
  std::mt19937 random(15);
  Bench bench(jaws(4));
  const Stroke stroke = random_stroke(random, 1.0);
  Contact contact = bench.contact();
  const tests::NoAlloc guard;
  const double first_J = given_energy_J(contact, stroke, 1000);
  render_at(contact, stroke.at(0.5));
  contact.reset();
  EXPECT_EQ(given_energy_J(contact, stroke, 1000), first_J);
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::model::contact::whole_tool_test
