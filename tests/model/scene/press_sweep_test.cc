// SPDX-License-Identifier: Apache-2.0
// The sweep on shapes with a known answer, and broken laws, which it must name.
#include "model/scene/press_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/indent/rhombus_patch.h"
#include "model/scene/tissue.h"
#include "model/units.h"
#include "tests/support/message.h"
#include "tests/support/test_scene.h"

namespace tact::model::scene::press_sweep_test {

constexpr double kLimit_N_per_m = 400.0;
constexpr double kSpring_N_per_m = 100.0;

std::uint32_t middle_of(const mesh::SurfaceMesh& mesh) {
  return static_cast<std::uint32_t>(
      std::ranges::min_element(mesh.vertex_m, {}, [](const Vec3& v) { return norm(v); }) -
      mesh.vertex_m.begin());
}

TEST(PressSweep, PlateAnswersWithForceAndSlopeOfTheLaw) {
  const Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*make_tissue(scene));
  const law::Law& law = *tissue->law().curve();
  const double range_m = law.range().press_m;
  const std::vector<PressPoint> places{{middle_of(scene.organ_mesh), PressWay::kSquare},
                                       {middle_of(scene.organ_mesh), PressWay::kUpright}};
  const auto sweep = sweep_presses(scene, places, {.limit_N_per_m = kLimit_N_per_m});
  ASSERT_EQ(tests::message_of(sweep), "");
  EXPECT_EQ(sweep->settings.depth_m, range_m) << "the working range, as no depth was asked for";
  EXPECT_TRUE(sweep->settings.checks_energy);
  double steepest_N_per_m = 0.0;
  for (double d_m = 0.0; d_m < range_m; d_m += 1e-5)
    steepest_N_per_m = std::max(steepest_N_per_m, law.respond(d_m).stiffness_N_per_m);
  for (const PressResult& r : sweep->results) {
    EXPECT_EQ(r.state, PressState::kPressed);
    EXPECT_EQ(describe_flaws(r, sweep->settings), "");
    EXPECT_NEAR(r.deepest_m, range_m, 2e-5);
    EXPECT_NEAR(r.force_N, law.respond(r.deepest_m).force_N, 1e-3 * r.force_N);
    EXPECT_NEAR(r.slope_N_per_m.value, steepest_N_per_m, 0.01 * steepest_N_per_m);
    EXPECT_NEAR(r.change_N.value, steepest_N_per_m * 2e-5, 0.01 * steepest_N_per_m * 2e-5);
    EXPECT_EQ(r.least_N.value, 0.0);
    EXPECT_EQ(r.energy_ratio.value, 0.0);
  }
  EXPECT_EQ(sweep->stiffest()->place.vertex, middle_of(scene.organ_mesh));
  EXPECT_TRUE(sweep->flawed().empty());
}

/// A spring, and what may be wrong with it.
class BrokenLaw : public contact::ContactLaw {
 public:
  double snap_at_m = 1.0, snap_N = 0.0;  // a force that comes all at once
  double draws_N_per_m = 0.0;            // beyond 2 mm it falls with this slope
  double stored_ratio = 1.0;             // of what it should store
  double spring_N_per_m = kSpring_N_per_m;

  contact::ContactLawResponse respond(const contact::Indentation& in) RT_SAFE override {
    const double d_m = std::max(in.indentation_m, 0.0), beyond_m = std::max(d_m - 2_mm, 0.0);
    double force_N = spring_N_per_m * d_m - draws_N_per_m * beyond_m;
    double energy_J = 0.5 * spring_N_per_m * d_m * d_m - 0.5 * draws_N_per_m * beyond_m * beyond_m;
    if (d_m > snap_at_m) {
      force_N += snap_N;
      energy_J += snap_N * (d_m - snap_at_m);
    }
    return {.law = {.force_N = force_N,
                    .stiffness_N_per_m = spring_N_per_m,
                    .energy_J = stored_ratio * energy_J}};
  }
  std::size_t profile(const contact::Indentation&, std::span<double>) const RT_SAFE override {
    return 0;
  }
  double ring_pitch_m() const RT_SAFE override { return 1_mm; }
  void leave(std::size_t) RT_SAFE override {}
  void advance() RT_SAFE override {}
};

class PressOnce : public ::testing::Test {
 protected:
  PressResult press() {
    scene_.law = &law_;
    return press_once(scene_, {0, 0, -1}, {middle_of(plate_), PressWay::kSquare}, settings_);
  }
  std::string flaws() { return describe_flaws(press(), settings_); }

  BrokenLaw law_;
  mesh::SurfaceMesh plate_ = tests::make_plate(0.2, 20);
  contact::TriangleTree tree_ = contact::make_triangle_tree(plate_.view());
  std::vector<contact::ProbeSphere> spheres_{{{}, 4_mm}};
  contact::ContactScene scene_{.law = nullptr,
                               .parameters = {.tear_force_N = 1.0},
                               .spheres = spheres_,
                               .surface = plate_.view(),
                               .tree = tree_.view(),
                               .blade = {}};
  PressSettings settings_{.depth_m = 5_mm, .limit_N_per_m = kLimit_N_per_m};
};

TEST_F(PressOnce, SpringIsSound) {
  EXPECT_EQ(flaws(), "");
  EXPECT_NEAR(press().slope_N_per_m.value, kSpring_N_per_m, 1e-6);
}

TEST_F(PressOnce, NamesASnapAndItsDepthAndNotAsASlope) {
  law_.snap_at_m = 3_mm;
  law_.snap_N = 0.05;
  const PressResult r = press();
  EXPECT_TRUE(flaws_of(r, settings_).changes_too_fast);
  EXPECT_FALSE(flaws_of(r, settings_).is_too_stiff);
  EXPECT_NEAR(r.change_N.value, 0.05 + kSpring_N_per_m * 2e-5, 1e-6);
  EXPECT_NEAR(r.change_N.depth_m, 3_mm, 3e-5);
  EXPECT_NEAR(r.slope_N_per_m.value, kSpring_N_per_m, 1e-6);
  EXPECT_NE(flaws().find("the force changes by 0.052 N in 0.02 mm at 3.0"), std::string::npos)
      << flaws();
  law_.snap_N = 0.005;  // with the spring's share 7 mN: 400 N/m times 0.02 mm allow 8
  EXPECT_EQ(flaws(), "");
}

TEST_F(PressOnce, NamesAForceThatDrawsTheToolIn) {
  law_.draws_N_per_m = 300.0;
  const PressResult r = press();
  EXPECT_TRUE(flaws_of(r, settings_).draws_in);
  EXPECT_NEAR(r.least_N.value, 100.0 * 0.005 - 300.0 * 0.003, 1e-2);
  law_.draws_N_per_m = 150.0;  // falls, and still pushes: as on a steep flank
  EXPECT_EQ(flaws(), "");
}

TEST_F(PressOnce, NamesASlopeAboveTheLimit) {
  law_.spring_N_per_m = 1.02 * kLimit_N_per_m;
  EXPECT_TRUE(flaws_of(press(), settings_).is_too_stiff);
  law_.spring_N_per_m = 0.98 * kLimit_N_per_m;
  EXPECT_EQ(flaws(), "");
}

TEST_F(PressOnce, NamesAnEnergyThatIsNotTheWork) {
  for (const double ratio : {0.95, 1.05}) {
    law_.stored_ratio = ratio;
    EXPECT_TRUE(flaws_of(press(), settings_).energy_differs) << ratio;
    EXPECT_NEAR(press().energy_ratio.value, ratio - 1.0, 0.02) << ratio;
  }
  law_.stored_ratio = 1.01;
  EXPECT_EQ(flaws(), "");
}

TEST_F(PressOnce, ReportsAToolThatCannotStart) {
  // In a bowl 12 mm wide one of two spheres 20 mm apart is always in the tissue.
  const mesh::SurfaceMesh bowl = tests::make_bowl(12_mm, 3);
  const contact::TriangleTree tree = contact::make_triangle_tree(bowl.view());
  spheres_ = {{{0, -10_mm, 0}, 4_mm}, {{0, 10_mm, 0}, 4_mm}};
  scene_.spheres = spheres_, scene_.surface = bowl.view(), scene_.tree = tree.view();
  scene_.law = &law_;
  EXPECT_EQ(press_once(scene_, {0, 0, -1}, {5, PressWay::kSquare}, settings_).state,
            PressState::kBlocked);
}

TEST_F(PressOnce, ReportsAToolThatPassesTheOrgan) {
  spheres_ = {{{0, 0.3, 0}, 4_mm}};  // beside the plate
  const PressResult r = press();
  EXPECT_EQ(r.state, PressState::kMissed);
  EXPECT_FALSE(flaws_of(r, settings_).any());
}

TEST(PressPlaces, AreSpreadAndUprightOnesFaceTheHand) {
  Scene scene = tests::make_plate_scene();
  scene.organ_mesh = tests::make_ball(0.05, 3);
  const std::size_t vertices = scene.organ_mesh.vertex_m.size();
  EXPECT_EQ(press_points(scene, 0, true, false).size(), vertices);
  const auto ten = press_points(scene, 10, true, true);
  ASSERT_EQ(ten.size(), 20U);
  EXPECT_EQ(ten[0].vertex, 0U);
  EXPECT_GE(ten[9].vertex, 9 * vertices / 10);
  for (const PressPoint& place : press_points(scene, 0, false, true)) {
    EXPECT_EQ(place.way, PressWay::kUpright);
    EXPECT_GE(scene.organ_mesh.vertex_normal[place.vertex].z, 0.5);
  }
}

TEST(PressSweep, WorstPlaceComesFirst) {
  PressSweep sweep{.settings = {.limit_N_per_m = kLimit_N_per_m}, .results = {}};
  for (std::uint32_t v = 0; v < 3; ++v) {
    PressResult r;
    r.place.vertex = v;
    r.state = PressState::kPressed;
    r.change_N = {std::array{0.0, 0.01, 0.1}[v], 0.0};
    sweep.results.push_back(r);
  }
  ASSERT_EQ(sweep.flawed().size(), 2U);
  EXPECT_EQ(sweep.flawed()[0]->place.vertex, 2U);
}

TEST(PressSweep, ErrorWhereItWasStoppedOrTheLawHasNoMeaning) {
  Scene scene = tests::make_plate_scene();
  const std::vector<PressPoint> places{{0, PressWay::kSquare}};
  const auto stopped =
      sweep_presses(scene, places, {}, [](std::size_t, std::size_t) { return false; });
  EXPECT_EQ(tests::message_of(stopped), "the sweep was stopped");
  scene.laws.of<indent::RhombusParameters>().chain.units = 0;
  EXPECT_NE(tests::message_of(sweep_presses(scene, places, {})), "");
}

}  // namespace tact::model::scene::press_sweep_test
