// A scene's law made ready to touch: what it says of itself must hold for all that can be felt.
#include "model/tissue_law.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/tissue_map.h"
#include "tests/test_scene.h"

namespace tact::model {
namespace {

using Overrides = std::vector<std::string>;

Scene shipped(const std::string& name, const Overrides& overrides = {}) {
  auto scene = load_scene(TACT_SOURCE_DIR "/model/scenes/" + name + ".toml", overrides);
  EXPECT_TRUE(scene) << scene.error().sentence;
  return scene ? std::move(*scene) : Scene{};
}

std::unique_ptr<TissueLaw> made(const Scene& scene, LawKind kind) {
  auto law = make_tissue_law(scene, kind);
  EXPECT_TRUE(law) << law.error().sentence;
  return law ? std::move(*law) : nullptr;
}

std::unique_ptr<TissueLaw> made(const Scene& scene) { return made(scene, scene.law); }

std::string refusal(const Scene& scene, LawKind kind) {
  const auto law = make_tissue_law(scene, kind);
  return law ? "" : law.error().sentence;
}

TEST(TissueLaw, SeesAStiffPullThatTearsWithinOneSample) {
  // 10 000 N/m reach the tear force of 0.6 N at 0.06 mm of 12 mm
  const Scene heart = shipped("heart", {"pull.stiffness_N_per_m=10000"});
  EXPECT_GE(made(heart)->stiffness_N_per_m(), 10000.0);
  EXPECT_LT(made(shipped("heart"))->stiffness_N_per_m(), 1000.0);
}

TEST(TissueLaw, StiffnessIsTheLargestSlopeShortOfTheTear) {
  Scene scene = tests::make_plate_scene();  // rhombi that stiffen as they are pulled
  for (const double tear_N : {0.05, 0.2, 0.6}) {
    scene.contact.tear_force_N = tear_N;
    const auto law = made(scene, LawKind::kRhombus);
    double most_N_per_m = law->curve()->respond(1e-9).stiffness_N_per_m;
    for (double d_m = -1e-9; d_m > law->range().pull_m; d_m -= 1e-6) {
      const LawResponse r = law->curve()->respond(d_m);
      if (r.force_N < -tear_N) break;
      most_N_per_m = std::max(most_N_per_m, r.stiffness_N_per_m);
    }
    EXPECT_NEAR(law->stiffness_N_per_m() / most_N_per_m, 1.0, 1e-3) << tear_N;
  }
}

TEST(TissueLaw, TitlesNameTheirSizes) {
  const Scene liver = shipped("liver");
  EXPECT_EQ(made(liver, LawKind::kRhombus)->title(), "rhombus chain, energy form, 10 units");
  EXPECT_EQ(made(liver, LawKind::kDiscStack)->title(), "disc stack, linear, 20 layers");
  EXPECT_EQ(made(liver, LawKind::kHexSheet)->title(), "hexagonal sheet, energy form, 15 rings");
  EXPECT_EQ(made(liver, LawKind::kHexSheetPaper)->title(), "hexagonal sheet, as printed, 15 rings");
  EXPECT_EQ(made(liver, LawKind::kCompliance)->title(), "linear elastic compliance, 17 curves");
  EXPECT_EQ(made(liver, LawKind::kSpringPatch)->title(),
            "mass-spring patch, 500 nodes, midpoint-averaging");
  const Scene varied = shipped("liver", {"varies_by_place=true"});
  EXPECT_EQ(made(varied)->title(), "rhombus chain, energy form, 10 units, scaled by place");
}

TEST(TissueLaw, ZeroRingsAreAsFewAsTheToleranceAllows) {
  const std::string few = made(shipped("skin", {"hex_sheet.rings=0"}))->title();
  EXPECT_EQ(few, made(shipped("skin"))->title());
  EXPECT_EQ(few.find(", 0 rings"), few.npos) << few;
}

TEST(TissueLaw, WhatVariesIsScaledAtEachVertexAsTheMapGives) {
  const Scene same = shipped("liver"), varied = shipped("liver", {"varies_by_place=true"});
  const auto family = read_scene_family(varied);
  ASSERT_TRUE(family) << family.error().sentence;
  const double half_m = 0.5 * varied.compliance.working_depth_m;
  const auto press = stiffness_factors(*family, family->press_coordinate, half_m);
  const auto pull = stiffness_factors(*family, family->pull_coordinate, -half_m);
  const auto law = made(varied), plain = made(same);
  const SurfaceView mesh = varied.organ_mesh.view();
  double least = 1e9, most = 0.0;
  for (std::uint32_t t = 0; t < mesh.triangle.size(); t += 97) {
    for (const double depth_m : {-0.004, 0.002, 0.006}) {
      const Indentation in{.place = {t, {1, 0, 0}}, .depth_m = depth_m, .held = true};
      const double ratio =
          law->site_law().respond(in).law.force_N / plain->site_law().respond(in).law.force_N;
      const auto& factor = depth_m < 0.0 ? pull : press;
      ASSERT_NEAR(ratio, static_cast<double>(factor[mesh.triangle[t][0]]), 1e-5 * ratio) << t;
      least = std::min(least, ratio), most = std::max(most, ratio);
    }
  }
  EXPECT_GT(most, 2.0 * least) << "the liver differs from place to place";
  EXPECT_GE(law->stiffness_N_per_m(), most * plain->stiffness_N_per_m() * (1.0 - 1e-6))
      << "the stiffest place counts";
}

TEST(TissueLaw, SlopeAlongTheSurfaceIsThatOfTheEnergy) {
  const Scene varied = shipped("liver", {"varies_by_place=true"});
  const SurfaceView mesh = varied.organ_mesh.view();
  for (const LawKind kind : {LawKind::kRhombus, LawKind::kDiscStack, LawKind::kHexSheet}) {
    const auto law = made(varied, kind);
    double largest_N = 0.0;
    for (std::uint32_t t = 5; t < mesh.triangle.size(); t += 311) {
      const auto at = [&](double a, double b) {
        return law->site_law().respond({.place = {t, {1.0 - a - b, a, b}}, .depth_m = 0.005});
      };
      const TriangleCorners& corner = mesh.triangle[t];
      const double e = 1e-3;
      const Vec3 ab_m = mesh.vertex_m[corner[1]] - mesh.vertex_m[corner[0]];
      const Vec3 ac_m = mesh.vertex_m[corner[2]] - mesh.vertex_m[corner[0]];
      const Vec3 slope_N = at(0.3, 0.3).slope_N;
      const double along_ab_J = at(0.3 + e, 0.3).law.energy_J - at(0.3 - e, 0.3).law.energy_J;
      const double along_ac_J = at(0.3, 0.3 + e).law.energy_J - at(0.3, 0.3 - e).law.energy_J;
      EXPECT_NEAR(along_ab_J / (2 * e), dot(slope_N, ab_m), 1e-10);
      EXPECT_NEAR(along_ac_J / (2 * e), dot(slope_N, ac_m), 1e-10);
      largest_N = std::max(largest_N, norm(slope_N));
    }
    EXPECT_GT(largest_N, 1e-3) << name_of(kind);
  }
}

TEST(TissueLaw, RefusesTipsOfTwoSizesWhereTheMapKnowsOne) {
  Scene liver = shipped("liver");
  liver.tool.spheres[1].radius_m = 0.005;
  const std::string said = refusal(liver, LawKind::kCompliance);
  EXPECT_NE(said.find("radii of 0.004 and 0.005 m"), said.npos) << said;
  EXPECT_EQ(refusal(liver, LawKind::kRhombus), "");
  liver.varies_by_place = true;
  EXPECT_NE(refusal(liver, LawKind::kRhombus), "");
}

}  // namespace
}  // namespace tact::model
