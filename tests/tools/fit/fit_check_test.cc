// SPDX-License-Identifier: Apache-2.0
#include "tools/fit/fit_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/units.h"
#include "tests/support/test_scene.h"
#include "tools/fit/fit_run.h"
#include "tools/report/just_noticeable.h"

namespace tact::tools::fit::fit_check_test {

using model::operator""_mm;

/// F = scale (d / 10 mm)^power at ten depths.
FitSite power_site(const std::string& name, double scale_N, double power) {
  FitSite site{.name = name};
  for (int i = 1; i <= 10; ++i)
    site.samples.push_back({.depth_m = i * 1_mm, .force_N = scale_N * std::pow(0.1 * i, power)});
  return site;
}

std::vector<FitAnswer> line(const FitData& data, double stiffness_N_per_m) {
  std::vector<FitAnswer> answers;
  for (const FitSite& site : data.sites)
    for (const FitSample& s : site.samples)
      answers.push_back({.force_N = stiffness_N_per_m * s.depth_m});
  return answers;
}

bool says(const Evaluation& j, const std::string& words) {
  for (const std::string& reason : j.reasons)
    if (reason.find(words) != std::string::npos) return true;
  return false;
}

TEST(FitCheck, MatchesPenAndPaper) {
  FitData data{.sites = {{.name = "a", .samples = {{1_mm, 1.0}, {2_mm, 2.0}}}}};
  const std::vector<FitAnswer> answers{{.force_N = 1.1}, {.force_N = 1.7}};
  const Evaluation j = check(data, answers, false, 10_mm);
  EXPECT_NEAR(j.fitted.rms_N, std::sqrt((0.01 + 0.09) / 2.0), 1e-12);
  EXPECT_NEAR(j.fitted.worst_N, 0.3, 1e-12);
  EXPECT_NEAR(j.fitted.worst_ratio(), 0.15, 1e-12);
  EXPECT_NEAR(j.sites[0].best_scale, (1.1 + 3.4) / (1.21 + 2.89), 1e-12);
  EXPECT_EQ(j.held_out.samples, 0U);
}

TEST(FitCheck, MeasuresTheShapeAgainstTheDepth) {
  const FitSample sample{.depth_m = 2_mm, .force_N = 1.0, .ring_m = {2_mm, 1_mm, std::nan("")}};
  // errors 0 and 0.2 mm over 2 mm; what is not known is not compared
  EXPECT_NEAR(shape_error(sample, {.ring_m = {2_mm, 1.2_mm, 9_mm}}), 0.1 / std::sqrt(2.0), 1e-12);
  EXPECT_TRUE(std::isnan(shape_error(sample, {})));
}

TEST(FitCheck, KeepsHeldOutSitesApart) {
  FitData data{.sites = {power_site("a", 0.5, 1.0), power_site("b", 1.0, 1.0)}};
  data.sites[1].held_out = true;
  const Evaluation j = check(data, line(data, 50.0), false, 1.0);
  EXPECT_NEAR(j.fitted.rms_N, 0.0, 1e-12);
  EXPECT_NEAR(j.held_out.worst_N, 0.5, 1e-12);
  EXPECT_FALSE(j.follows);
  EXPECT_TRUE(says(j, "sites differ by ±33 %")) << j.reasons[0];
}

TEST(FitCheck, AFactorForEachSiteTakesTheirDifferenceAway) {
  const FitData data{.sites = {power_site("a", 0.5, 1.0), power_site("b", 1.0, 1.0)}};
  const Evaluation j = check(data, line(data, 75.0), true, 1.0);
  EXPECT_TRUE(j.follows);
  EXPECT_NEAR(j.sites[0].scale, 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(j.sites[1].scale, 4.0 / 3.0, 1e-12);
}

TEST(FitCheck, ARhombusChainCannotFollowARoundTip) {
  // Hertz: F grows like d^1.5; the chain softens in press (RC-5).
  model::scene::Scene scene = tests::make_plate_scene();
  scene.described = {"rhombus"};
  const FitData data{.sites = {power_site("a", 0.5, 1.5)}};
  FitLaw law = fit_laws_of(scene, data)[0];
  law.most_evaluations = 300;
  const auto fitted = fit_law(law, scene, data, {});
  ASSERT_TRUE(fitted) << fitted.error().message;
  const Evaluation& j = fitted->checked;
  EXPECT_FALSE(j.follows);
  EXPECT_GT(j.fitted.rms_ratio(), report::kJustNoticeable_ratio);
  EXPECT_LT(j.fitted.rms_ratio(), 0.10);  // a straight line leaves 7.3 %
  EXPECT_TRUE(says(j, "while the data hardens")) << j.reasons[0];
}

// An RMS of the peak hides both.
TEST(FitCheck, ATenthOfTheForceAtLightTouchIsNotFollowed) {
  const FitData data{.sites = {{.name = "a", .samples = {{1_mm, 0.02}, {5_mm, 0.4}, {9_mm, 1.0}}}}};
  const auto at_1_mm = [&](double force_N) {
    return check(data, std::vector<FitAnswer>{{force_N}, {0.4}, {1.0}}, false, 1.0);
  };
  const Evaluation tenth = at_1_mm(0.002);
  EXPECT_LT(tenth.fitted.rms_ratio(), 0.02);
  EXPECT_NEAR(tenth.fitted.local_ratio, 0.18, 1e-12) << "18 mN of 0.1 N";
  EXPECT_FALSE(tenth.follows);
  EXPECT_TRUE(says(tenth, "at 1 mm it gives 0.002 N, the data 0.02 N")) << tenth.reasons[0];
  EXPECT_TRUE(at_1_mm(0.014).follows) << "6 mN, below the floor of 7 mN";
}

TEST(FitCheck, LoadingAndUnloadingAreNotAveraged) {
  FitData data{.sites = {{.name = "a", .samples = {}}}};
  std::vector<FitAnswer> mean;
  for (double d_mm = 1.0; d_mm <= 10.0; d_mm += 1.0) {
    const double force_N = 0.1 * d_mm, loss_N = 0.006 * d_mm * (10.0 - d_mm);
    for (const double branch : {1.0, -1.0}) {
      data.sites[0].samples.push_back({d_mm * 1_mm, force_N + branch * 0.25 * loss_N});
      mean.push_back({.force_N = force_N});
    }
  }
  const Evaluation j = check(data, mean, false, 1.0);
  EXPECT_LT(j.fitted.rms_ratio(), 0.046);
  EXPECT_FALSE(j.follows);
}

TEST(FitCheck, SaysWhereALawEnds) {
  const FitData data{.sites = {power_site("a", 0.5, 1.0)}};
  std::vector<FitAnswer> answers = line(data, 50.0);
  for (FitAnswer& a : answers) a.force_N = std::min(a.force_N, 0.2);
  EXPECT_TRUE(says(check(data, answers, false, 4_mm), "its force stays from 4 mm on"));
}

}  // namespace tact::tools::fit::fit_check_test
