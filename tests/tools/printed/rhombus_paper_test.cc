// SPDX-License-Identifier: Apache-2.0
#include "tools/printed/rhombus_paper.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/units.h"

namespace tact::tools::printed::rhombus_paper_test {

using namespace model;
using namespace model::indent;

RhombusUnit liver_at(double angle_rad) {
  return {.rod_length_m = 10_mm,
          .initial_angle_rad = angle_rad,
          .normal_stiffness_N_per_m = 1.5,
          .tangential_stiffness_N_per_m = 1.8};
}

TEST(RhombusPaper, HasNoStiffnessLeftAt42Degrees) {
  // tan^2(theta0) = kN / kT = 1.5 / 1.8 at 42.392 degrees
  EXPECT_NEAR(paper_initial_stiffness_N_per_m(liver_at(42.3920_deg)), 0.0, 1e-5);
  EXPECT_FALSE(paper_is_singular(liver_at(42.3_deg)));
  EXPECT_TRUE(paper_is_singular(liver_at(42.5_deg)));
}

TEST(RhombusPaper, SucksTheProbeInAt45Degrees) {
  EXPECT_NEAR(paper_initial_stiffness_N_per_m(liver_at(45_deg)), -0.3, 1e-12);
  EXPECT_GT(paper_forward(liver_at(45_deg), -0.01).force_N, 0.0)
      << "pressed (dtheta < 0), yet it pulls (F > 0)";
}

TEST(RhombusPaper, PressesLessThanHalfOfTheEnergyForce) {
  // X1: (3) as printed over RC-4 is 0.436 at dtheta = -0.01 rad, 30 degrees
  const RhombusUnit unit = liver_at(30_deg);
  const PaperUnit printed = paper_forward(unit, -0.01);
  const double energy_N = respond(unit, -printed.shortening_m).force_N;
  EXPECT_NEAR(-printed.force_N / energy_N, 0.436, 0.0005);
}

TEST(RhombusPaper, ReturnsHalfTheForceFromItsEnergyFormula) {
  // (12) divides energy by displacement: half of the force in the small-strain limit
  const RhombusUnit unit = liver_at(30_deg);
  const PaperUnit at = paper_forward(unit, -1e-6);
  const double energy_N = respond(unit, -at.shortening_m).force_N;
  EXPECT_NEAR(at.energy_J / -at.shortening_m / energy_N, 0.5, 1e-5);
}

TEST(RhombusPaper, ForceIsNotTheSlopeOfItsEnergy) {
  const RhombusUnit unit = liver_at(30_deg);
  const double h = 1e-6;
  const PaperUnit a = paper_forward(unit, -0.1 - h), b = paper_forward(unit, -0.1 + h);
  const double slope_N = (a.energy_J - b.energy_J) / (a.shortening_m - b.shortening_m);
  EXPECT_GT(std::abs(slope_N / paper_forward(unit, -0.1).force_N - 1.0), 0.3);
}

}  // namespace tact::tools::printed::rhombus_paper_test
