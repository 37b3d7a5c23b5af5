// SPDX-License-Identifier: Apache-2.0
// Laws against published measurements; model/MEASURED.md says who measured and what stays open.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "model/indent/compliance_tip.h"
#include "model/law/relaxation.h"
#include "model/scene/scene.h"
#include "tests/tools/fit/fit_fixture.h"
#include "tools/fit/fit_csv.h"

namespace tact::tools::fit::measured_test {

using model::law::PronyTerm;

const std::string kRoot = TACT_SOURCE_DIR;

/// Silicone cylinders between plates: EF10_100T is fitted, the others evaluate with a factor each.
Evaluation check_silicone(const std::string& law, double deepest_m) {
  const auto scene =
      model::scene::load_scene(kRoot + "/model/scenes/liver.toml", {"varies_by_place=false"});
  EXPECT_TRUE(scene) << scene.error().message;
  const auto data = read_bench_csv(kRoot + "/tests/data/measured/silicone_compression.csv",
                                   {.depth = "compression_mm",
                                    .force = "load_mean_N",
                                    .depth_unit_m = 0.001,
                                    .deepest_m = deepest_m},
                                   {"EF10_50T", "EF30_50T"});
  EXPECT_TRUE(data) << data.error().message;
  return fit(law, *scene, *data, {.scale_by_site = true}).checked;
}

TEST(Measured, ASheetFittedToOneSiliconeFollowsTwoOthersTo30PercentStrain) {
  const Evaluation checked = check_silicone("hex_sheet", 0.009);
  ASSERT_EQ(checked.sites.size(), 3U);
  for (const SiteResidual& site : checked.sites) {
    EXPECT_EQ(site.held_out, site.name != "EF10_100T");
    EXPECT_EQ(site.force.samples, 31U);  // every 0.3 mm, and at rest
    EXPECT_GT(site.force.rms_ratio(), 0.003) << site.name;
    EXPECT_LT(site.force.rms_ratio(), 0.012) << site.name;
  }
}

// E of two shipped scenes: force over area and strain, of 30 mm, diameter 50 mm.
TEST(Measured, TheShippedSiliconesHaveTheModulusOfTheirCylinders) {
  const auto data = read_bench_csv(
      kRoot + "/tests/data/measured/silicone_compression.csv",
      {.depth = "compression_mm", .force = "load_mean_N", .depth_unit_m = 0.001}, {});
  ASSERT_TRUE(data) << data.error().message;
  for (const auto& [name, material, pressed_m] :
       {std::tuple{"gum", "EF30_50T", 0.003}, std::tuple{"maintenance", "EF10_100T", 0.003}}) {
    const auto scene = model::scene::load_scene(kRoot + "/model/scenes/" + name + ".toml", {});
    ASSERT_TRUE(scene && scene->elastic) << name;
    const auto site = std::ranges::find(data->sites, material, &FitSite::name);
    ASSERT_NE(site, data->sites.end());
    const auto at = std::ranges::min_element(
        site->samples, {}, [&](const FitSample& s) { return std::abs(s.depth_m - pressed_m); });
    ASSERT_NE(at, site->samples.end());
    const double modulus_Pa = at->force_N / (M_PI * 0.025 * 0.025) / (at->depth_m / 0.030);
    EXPECT_NEAR(scene->elastic->youngs_modulus_Pa / modulus_Pa, 1.0, 0.015) << name;
  }
}

TEST(Measured, NoLinearStackFollowsSiliconeTo60PercentStrain) {
  const Evaluation checked = check_silicone("disc_stack_linear", 0.018);
  for (const SiteResidual& site : checked.sites) {
    EXPECT_GT(site.force.rms_ratio(), 0.12) << site.name;
    EXPECT_LT(site.force.rms_ratio(), 0.16) << site.name;
  }
}

// Finite elements at one place of the liver: one spring is too stiff at small depths, unless the
// tip's own indentation is in series with it.
TEST(Measured, OneSpringUnderAnExactTipFollowsAPlaceOfTheLiver) {
  FitData place{.sites = {{.name = "1725",
                           .samples = {{0.001, 0.0121933},
                                       {0.002, 0.0317602},
                                       {0.0035, 0.0670282},
                                       {0.005, 0.106287},
                                       {0.007, 0.162209},
                                       {0.01, 0.251425}}}}};
  const auto worst_ratio = [&](const std::string& exact_tip) {
    const auto scene = model::scene::load_scene(
        kRoot + "/model/scenes/liver.toml",
        {"varies_by_place=false", "compliance.large_strain=false", "exact_tip=" + exact_tip});
    EXPECT_TRUE(scene) << scene.error().message;
    return fit("disc_stack_linear", *scene, place).checked.fitted.local_ratio;
  };
  EXPECT_GT(worst_ratio("false"), 0.12);
  EXPECT_LT(worst_ratio("true"), 0.01);
}

// A step of force on a linear law with two terms: with a = 1 / tau_1, b = 1 / tau_2 the indentation
// grows as 1 / g_0 + sum of R_i exp(-t / lambda_i), where 1 / lambda_i = p, q solve
//
//     p + q = (g_0 + g_2) a + (g_0 + g_1) b          p q = g_0 a b
//
// [Laplace transform of RX-1; R_p = (a - p)(p - b) / (p (q - p)), R_q likewise].
struct Creep {
  double fast_s, slow_s;
};

Creep creep_of(const PronyTerm& one, const PronyTerm& two) {
  const double a = 1.0 / one.time_s, b = 1.0 / two.time_s, g0 = 1.0 - one.share - two.share;
  const double half = 0.5 * ((g0 + two.share) * a + (g0 + one.share) * b);
  const double root = std::sqrt(half * half - g0 * a * b);
  return {1.0 / (half + root), 1.0 / (half - root)};
}

// Kerdok 2006: perfused porcine liver under a constant load, 300 s.
constexpr Creep kLiver{.fast_s = 1.86, .slow_s = 51.3};

TEST(Measured, ALiverThatCreepsAsPublishedRelaxesInShorterTimes) {
  const PronyTerm one{.share = 0.3, .time_s = 1.308}, two{.share = 0.2, .time_s = 36.48};
  const Creep creep = creep_of(one, two);
  EXPECT_NEAR(creep.fast_s, kLiver.fast_s, 0.002);
  EXPECT_NEAR(creep.slow_s, kLiver.slow_s, 0.02);

  // and so does the relaxation that the loop steps, under 1 N on a spring of 1 N/m
  const double tick_s = 0.01, a = 1.0 / one.time_s, b = 1.0 / two.time_s;
  const double p = 1.0 / creep.fast_s, q = 1.0 / creep.slow_s;
  const auto relaxation = model::law::make_relaxation(std::array{one, two}, tick_s);
  ASSERT_TRUE(relaxation);
  model::law::RelaxationState now;
  const auto force_N = [&](const model::law::RelaxationState& s) {
    return 0.5 * s.depth_m + 0.3 * s.stretch_m[0] + 0.2 * s.stretch_m[1];
  };
  for (int tick = 0; tick < 30'000; ++tick) {
    const double at_0_N = force_N(relaxation->after(now, 0.0, true));
    const double at_1_N = force_N(relaxation->after(now, 1.0, true));
    now = relaxation->after(now, (1.0 - at_0_N) / (at_1_N - at_0_N), true);
    const double t_s = tick_s * tick;
    const double indentation_m = 2.0 + (a - p) * (p - b) / (p * (q - p)) * std::exp(-p * t_s) +
                                 (a - q) * (q - b) / (q * (p - q)) * std::exp(-q * t_s);
    ASSERT_NEAR(now.depth_m, indentation_m, 0.005) << t_s;
  }
}

TEST(Measured, TheIllustrativeRelaxationCreepsFasterThanAPorcineLiver) {
  const auto scene = model::scene::load_scene(kRoot + "/model/scenes/skin.toml", {});
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_EQ(scene->relaxation.size(), 2U);
  const Creep creep = creep_of(scene->relaxation[0], scene->relaxation[1]);
  EXPECT_NEAR(kLiver.fast_s / creep.fast_s, 2.6, 0.05);
  EXPECT_NEAR(kLiver.slow_s / creep.slow_s, 4.5, 0.05);
}

// Truth Cube: 80 mm of silicone, sphere of 25.4 mm diameter, 798 N/m "in indentation".
TEST(Measured, NoSphereOfTheTruthCubeReachesItsStiffnessOnAHalfSpace) {
  const model::indent::ElasticTip tip{
      .youngs_modulus_Pa = 15.3e3, .poisson_ratio = 0.499, .radius_m = 0.0127};
  EXPECT_NEAR(tip.stiffest_press_N_per_m(), 517.0, 1.0);  // CT-3 with a = R: 2 E* R
  EXPECT_NEAR(tip.stiffest_press_N_per_m() / 798.0, 0.65, 0.005);
  EXPECT_NEAR(798.0 / (2.0 * tip.contact_modulus_Pa()), 0.0196, 5e-5);  // a flat punch that would
  EXPECT_LT(0.22 * 0.080 / tip.radius_m, model::indent::kDeepestIndentation_ratio);
  EXPECT_GT(0.36 * 0.080 / tip.radius_m, model::indent::kDeepestIndentation_ratio);
}

}  // namespace tact::tools::fit::measured_test
