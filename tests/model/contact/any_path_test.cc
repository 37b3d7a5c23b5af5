// SPDX-License-Identifier: Apache-2.0
// Random paths of a tool through thin, hollow, near, sharp and round bodies: contact_rules.h holds.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>

#include "tests/support/extent.h"
#include "tests/support/path_run.h"

namespace tact::model::contact::any_path_test {

mesh::SurfaceMesh flap(double thickness_m, double edge_m, double bend_radius_m = 0.0,
                       double gap_m = 0.0) {
  // As long as it takes about 5000 triangles, at most 100 mm.
  const double side_m = std::min(100_mm, 34 * edge_m);
  return tests::make_flap({.length_m = side_m,
                           .width_m = 0.8 * side_m,
                           .thickness_m = thickness_m,
                           .edge_m = edge_m,
                           .bend_radius_m = bend_radius_m,
                           .gap_m = gap_m});
}

mesh::SurfaceMesh body_of(const std::string& name) {
  using tests::join, tests::shifted, tests::make_ellipsoid;
  if (name == "flap_1mm") return flap(1_mm, 1.2_mm);
  if (name == "flap_2mm") return flap(2_mm, 5_mm);
  if (name == "flap_4mm") return flap(4_mm, 5_mm);
  if (name == "flap_8mm") return flap(8_mm, 5_mm);
  if (name == "flap_12mm_bent") return flap(12_mm, 4_mm, 40_mm);
  if (name == "flap_3mm_bent") return flap(3_mm, 2.5_mm, 25_mm);
  if (name == "flap_folded") return flap(6_mm, 3_mm, 0.0, 5_mm);
  if (name == "two_sheets")
    return join(flap(1_mm, 1.2_mm), shifted(flap(1_mm, 1.2_mm), {0, 0, -2_mm}));
  if (name == "two_lobes")
    return join(make_ellipsoid({35_mm, 25_mm, 12_mm}, 4),
                shifted(make_ellipsoid({30_mm, 25_mm, 10_mm}, 4), {8_mm, 0, -24_mm}));
  if (name == "torus") return tests::make_torus(28_mm, 9_mm, 72, 36);
  if (name == "bladder") return tests::make_bladder({35_mm, 30_mm, 25_mm}, 4_mm, 4);
  if (name == "ball") return tests::make_ball(30_mm, 4);
  if (name == "box")
    return tests::make_flap(
        {.length_m = 60_mm, .width_m = 50_mm, .thickness_m = 40_mm, .edge_m = 5_mm});
  if (name == "box_of_few")  // triangles
    return tests::make_flap(
        {.length_m = 60_mm, .width_m = 60_mm, .thickness_m = 30_mm, .edge_m = 60_mm});
  ADD_FAILURE() << name;
  return {};
}

class AnyPath : public ::testing::TestWithParam<const char*> {};

TEST_P(AnyPath, KeepsTheRulesOfContact) {
  const tests::PathCounts counts =
      tests::run_random_paths(GetParam(), body_of(GetParam()), tests::share_of(100'000, 6'000'000));
  RecordProperty("counts", counts.summary());
  EXPECT_TRUE(counts.broken.empty()) << counts.summary() << "\n" << counts.first;
  EXPECT_GT(counts.pauses, tests::share_of(5, 5));
  EXPECT_LT(counts.forks, 2 + counts.pauses / 50);
  EXPECT_LT(static_cast<double>(counts.unsettled), 0.03 * static_cast<double>(counts.ticks));
}

INSTANTIATE_TEST_SUITE_P(Bodies, AnyPath,
                         ::testing::Values("flap_1mm", "flap_2mm", "flap_4mm", "flap_8mm",
                                           "flap_12mm_bent", "flap_3mm_bent", "flap_folded",
                                           "two_sheets", "two_lobes", "torus", "bladder", "ball",
                                           "box", "box_of_few"));

using BodyAndRate = std::tuple<const char*, double>;
class AnyPathRate : public ::testing::TestWithParam<BodyAndRate> {};

TEST_P(AnyPathRate, KeepsTheRulesOfContact) {
  const auto& [name, rate_Hz] = GetParam();
  const tests::PathCounts counts =
      tests::run_random_paths(name, body_of(name), tests::share_of(400'000, 6'000'000), rate_Hz);
  EXPECT_TRUE(counts.broken.empty()) << counts.summary() << "\n" << counts.first;
}

INSTANTIATE_TEST_SUITE_P(RateHz, AnyPathRate,
                         ::testing::Combine(::testing::Values("flap_2mm", "two_lobes", "box"),
                                            ::testing::Values(100.0, 10000.0)));

// Paths of earlier long runs, each of which broke a rule.
void expect_kept(const std::string& name, const std::vector<std::uint32_t>& seeds) {
  const tests::PathCounts counts = tests::run_paths_of(name, body_of(name), seeds);
  EXPECT_TRUE(counts.broken.empty()) << name << ": " << counts.summary() << "\n" << counts.first;
}

TEST(AnyPathFound, RoundAnEdgeALaggingProxyPullsNothingIn) {
  expect_kept("flap_1mm", {272, 416, 739, 824, 1156, 1244});
  expect_kept("flap_2mm", {1257});
  expect_kept("flap_3mm_bent", {736});
  expect_kept("flap_12mm_bent", {864});
  expect_kept("box", {527});
}

TEST(AnyPathFound, DepthOffsetDoesNotShrinkBySliding) {
  expect_kept("two_lobes", {269, 807, 843, 1157});
  expect_kept("two_sheets", {1167});
  expect_kept("bladder", {437});
}

TEST(AnyPathFound, AForceThatWouldJumpFollows) {
  expect_kept("flap_4mm", {871, 889, 921});
  expect_kept("two_lobes", {837, 1263, 1291});
}

TEST(AnyPathFound, AContactThatLetsGoIsGoneIn100ms) {
  expect_kept("flap_1mm", {105, 226, 1280});
  expect_kept("flap_4mm", {116, 1153});
  expect_kept("torus", {375});
  expect_kept("bladder", {60, 590});
}

TEST(AnyPathFound, APauseBesideAForkIsNoPauseOfItsOwn) { expect_kept("flap_12mm_bent", {704}); }

}  // namespace tact::model::contact::any_path_test
