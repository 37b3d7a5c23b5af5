// SPDX-License-Identifier: Apache-2.0
// A scene's law made ready for contact: what it says of itself must hold for all that can be felt.
#include "model/scene/tissue_law.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "model/indent/compliance_tip.h"
#include "model/indent/rhombus_patch.h"
#include "model/scene/tissue_map.h"
#include "tests/model/scene/shipped_law.h"
#include "tests/support/mesh_files.h"
#include "tests/support/test_scene.h"

namespace tact::model::scene::tissue_law_test {

using shipped_law::kLinear;
using shipped_law::made;
using shipped_law::Overrides;
using shipped_law::refusal;
using shipped_law::shipped;

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
    const auto law = made(scene, "rhombus");
    double most_N_per_m = law->curve()->respond(1e-9).stiffness_N_per_m;
    for (double d_m = -1e-9; d_m > law->range().pull_m; d_m -= 1e-6) {
      const law::LawResponse r = law->curve()->respond(d_m);
      if (r.force_N < -tear_N) break;
      most_N_per_m = std::max(most_N_per_m, r.stiffness_N_per_m);
    }
    EXPECT_NEAR(law->stiffness_N_per_m() / most_N_per_m, 1.0, 1e-3) << tear_N;
  }
}

// Hertz: u(r) = d / pi ((2 - s^2) asin(1 / s) + sqrt(s^2 - 1)), s = r / a, a^2 = R d
TEST(TissueLaw, SpringsInARowAreDrawnAsAnIndentedHalfSpace) {
  constexpr double kDepth_m = 0.003, kRadius_m = 0.0065;  // of the fingertip
  const auto law = made(shipped("heart", {"varies_by_place=false"}));
  std::array<double, 32> ring_m{};
  const std::size_t rings = law->contact_law().profile({.indentation_m = kDepth_m}, ring_m);
  double sum_m2 = 0.0;
  std::size_t count = 0;
  for (std::size_t j = 0; j + 1 < rings; ++j, ++count) {
    const double s = static_cast<double>(j) * law->contact_law().ring_pitch_m() /
                     std::sqrt(kRadius_m * kDepth_m);
    const double u_m = s > 1.0 ? kDepth_m / std::numbers::pi *
                                     ((2.0 - s * s) * std::asin(1.0 / s) + std::sqrt(s * s - 1.0))
                               : kDepth_m * (1.0 - 0.5 * s * s);
    sum_m2 += (ring_m[j] - u_m) * (ring_m[j] - u_m);
  }
  ASSERT_GT(count, 10U);
  EXPECT_LT(std::sqrt(sum_m2 / static_cast<double>(count)), 0.08 * kDepth_m);
}

TEST(TissueLaw, TitlesNameTheirSizes) {
  const Scene liver = shipped("liver", {"varies_by_place=false"});
  const std::string patch = "rhombus chain, energy form, 10 units, in parallel under the tip";
  EXPECT_EQ(made(liver, "rhombus")->title(), patch);
  EXPECT_EQ(made(liver, "disc_stack")->title(), "disc stack, linear, 20 layers");
  EXPECT_EQ(made(liver, "hex_sheet")->title(), "hexagonal sheet, energy form, 15 rings");
  EXPECT_EQ(made(liver, "compliance")->title(),
            "elastic compliance, large strain under the tip, on an organ that bends");
  EXPECT_EQ(made(liver, "spring_patch")->title(), "mass-spring patch, 500 nodes, improved-euler");
  EXPECT_EQ(made(shipped("liver"))->title(), patch + ", on an organ that bends");
  EXPECT_EQ(
      made(shipped("gum"))->title(),
      "mass-spring patch, 300 nodes, improved-euler, under the tool elastic compliance, small "
      "strain under the tip, 17 curves");
}

// The net moves, is cut and is drawn; the tool gets the force of the organ.
TEST(TissueLaw, ASpringPatchOnAnOrganHasTheForceOfTheOrgan) {
  const Scene gum = shipped("gum");
  const auto patch = made(gum), organ = made(gum, "compliance");
  const contact::SurfaceView mesh = gum.organ_mesh.view();
  for (std::uint32_t t = 0; t < mesh.triangle.size(); t += 400) {
    const contact::Indentation at{.surface_point = {.triangle = t, .weight = {0.2, 0.3, 0.5}},
                                  .normal = mesh.vertex_normal[mesh.triangle[t][0]],
                                  .indentation_m = 1e-3};
    for (int tick = 0; tick < 20; ++tick, patch->contact_law().advance())
      EXPECT_EQ(patch->contact_law().respond(at).law.force_N,
                organ->contact_law().respond(at).law.force_N);
    contact::PatchShape shape{};
    EXPECT_TRUE(patch->contact_law().shape(shape));
    EXPECT_GT(shape.node_count, 0U);
    patch->contact_law().leave(0);
  }
}

TEST(TissueLaw, ZeroRingsAreAsFewAsTheToleranceAllows) {
  const std::string even = "varies_by_place=false";
  const std::string few = made(shipped("skin", {even, "hex_sheet.rings=0"}), "hex_sheet")->title();
  EXPECT_EQ(few, made(shipped("skin", {even}), "hex_sheet")->title());
  EXPECT_EQ(few.find(", 0 rings"), few.npos) << few;
}

TEST(TissueLaw, VaryingTissueIsInSeriesWithItsVertexCompliance) {
  const Scene varied = shipped("liver", {kLinear}),
              same = shipped("liver", {"varies_by_place=false"});
  const auto family = read_scene_family(varied);
  ASSERT_TRUE(family) << family.error().message;
  const auto compliance_m_per_N = [&](float kappa) {
    return family->curve[static_cast<std::size_t>(kappa)].regular_m_per_N();
  };
  const auto law = made(varied), tip = made(same);
  const contact::SurfaceView mesh = varied.organ_mesh.view();
  double least_N = 1e9, most_N = 0.0;
  std::size_t seen = 0;
  for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t) {
    const std::uint32_t v = mesh.triangle[t][0];
    for (const double depth_m : {-0.004, 0.001, 0.006}) {
      const float kappa = (depth_m < 0.0 ? family->pull_coordinate : family->press_coordinate)[v];
      // between two curves energies are blended: CF-2 says how near that is to the place's own
      if (std::abs(kappa - std::floor(kappa)) > 0.002F || kappa < 1.0F || kappa > 13.0F) continue;
      const contact::Indentation in{
          .surface_point = {t, {1, 0, 0}}, .indentation_m = depth_m, .held = true};
      const double force_N = law->contact_law().respond(in).law.force_N;
      const double indentation_m = depth_m - compliance_m_per_N(kappa) * force_N;
      const double tip_N = tip->curve()->respond(indentation_m).force_N;
      ASSERT_NEAR(force_N, tip_N, 2e-3 * std::abs(tip_N)) << t << " at " << depth_m;
      if (depth_m == 0.006)
        least_N = std::min(least_N, force_N), most_N = std::max(most_N, force_N);
      ++seen;
    }
  }
  EXPECT_GT(seen, 10U);
  EXPECT_GT(most_N, 2.0 * least_N) << "the liver differs from place to place";
  EXPECT_GE(law->stiffness_N_per_m(), tip->stiffness_N_per_m()) << "the stiffest place counts";
}

TEST(TissueLaw, IsAtMostHalfAsStiffAgainNearTheHeldSide) {
  const Overrides stiff{"rhombus.normal_stiffness_N_per_m=16", "pull.stiffness_N_per_m=300"};
  Overrides alone = stiff;
  alone.emplace_back("varies_by_place=false");
  const double ratio = made(shipped("liver", stiff))->stiffness_N_per_m() /
                       made(shipped("liver", alone))->stiffness_N_per_m();
  EXPECT_GT(ratio, 1.2);
  EXPECT_LT(ratio, 1.505);
}

TEST(TissueLaw, OneChainUnderTheWholeTipOrMoreTheDeeperItSinks) {
  const Overrides tip{"varies_by_place=false", "pull.limit_m=0.01"};
  const auto patch = made(shipped("liver", tip));
  Overrides one = tip;
  one.emplace_back("rhombus.area_m2=0");
  const auto chain = made(shipped("liver", one));
  const auto slope = [](const TissueLaw& law, double depth_m) {
    return law.curve()->respond(depth_m).stiffness_N_per_m;
  };
  EXPECT_LT(slope(*patch, 1e-5), 0.1 * slope(*patch, 0.002)) << "light touch is soft";
  EXPECT_GT(slope(*chain, 1e-5), 2.0 * slope(*chain, 0.002)) << "a chain softens";
}

// The tip by CT-8 and the organ's bending, or neither of the two.
TEST(TissueLaw, LargeStrainCorrectsTipAndBendingOrNeither) {
  EXPECT_TRUE(ComplianceSettings{}.large_strain) << "where the scene does not say";
  const Scene bends = shipped("liver"), linear = shipped("liver", {kLinear}),
              same = shipped("liver", {"varies_by_place=false"});
  const double radius_m = bends.tool.spheres[0].radius_m, nu = bends.elastic->poisson_ratio;
  for (const char* kind : {"rhombus", "disc_stack", "hex_sheet", "hunt_crossley"}) {
    const auto law = made(bends, kind), tip = made(same, kind);
    ASSERT_NE(law->organ(), nullptr) << kind;
    EXPECT_EQ(tip->organ(), nullptr) << kind;
    EXPECT_EQ(made(linear, kind)->organ(), nullptr) << kind;
    const auto ratio = [&](double depth_m) {
      return law->curve()->respond(depth_m).force_N / tip->curve()->respond(depth_m).force_N;
    };
    EXPECT_EQ(ratio(-0.004), 1.0) << kind;
    for (const double depth_m : {0.001, 0.004, 0.008})
      EXPECT_NEAR(ratio(depth_m), indent::large_strain_factor(nu, depth_m / radius_m).factor, 2e-4)
          << kind;
    EXPECT_EQ(law->organ()->surface.compliance.size(), bends.organ_mesh.vertex_m.size());
  }
  EXPECT_EQ(made(bends, "spring_patch")->organ(), nullptr) << "its net stays where it was drawn";
}

TEST(TissueLaw, ComplianceAtLargeStrainIsTheTipOnAnOrganThatBends) {
  const Scene bends = shipped("liver");
  const auto law = made(bends, "compliance");
  ASSERT_NE(law->organ(), nullptr);
  EXPECT_EQ(made(shipped("liver", {kLinear}), "compliance")->organ(), nullptr);
  EXPECT_EQ(law->organ()->range_m, bends.compliance.working_depth_m);
  // The rhombi were fitted to this tip, within 2 % from 0.5 mm on.
  const auto fitted = made(bends, "rhombus");
  for (const double depth_m : {0.001, 0.004, 0.008})
    EXPECT_NEAR(fitted->curve()->respond(depth_m).force_N / law->curve()->respond(depth_m).force_N,
                1.0, 0.025);
}

// A measured press has the strain of its tissue already.
TEST(TissueLaw, AMeasuredTableKeepsItsForceAtLargeStrain) {
  const std::string data = "table.data=\"press.csv\"";
  const auto law = made(shipped("liver", {data}), "table"),
             tip = made(shipped("liver", {data, "varies_by_place=false"}), "table");
  ASSERT_NE(law->organ(), nullptr);
  for (const double depth_m : {0.001, 0.003})
    EXPECT_EQ(law->curve()->respond(depth_m).force_N, tip->curve()->respond(depth_m).force_N);
}

TEST(TissueLaw, OnlyHuntAndCrossleyResistSpeedAndLessWhereTheOrganGives) {
  const Scene liver = shipped("liver", {kLinear});
  for (const std::string& kind : liver.described)
    EXPECT_EQ(made(liver, kind)->damping_Ns_per_m() > 0.0, kind == "hunt_crossley") << kind;
  const auto law = made(liver, "hunt_crossley");
  EXPECT_LE(law->damping_Ns_per_m(), 1.0001 * 0.1 * 0.537);
  double least_s_per_m = 1.0, most_s_per_m = 0.0;
  for (std::uint32_t t = 0; t < liver.organ_mesh.triangle.size(); t += 7) {
    const contact::Indentation in{
        .surface_point = {t, {1, 0, 0}}, .indentation_m = 0.005, .speed_mps = 0.05};
    const double force_N = law->contact_law().respond(in).law.force_N;
    const double lambda = law->contact_law().resistance_N(in, force_N) / (0.05 * force_N);
    least_s_per_m = std::min(least_s_per_m, lambda), most_s_per_m = std::max(most_s_per_m, lambda);
  }
  EXPECT_LT(most_s_per_m, 0.1001) << "of the tip alone";
  EXPECT_GT(least_s_per_m, 0.0);
  EXPECT_LT(least_s_per_m, 0.5 * most_s_per_m) << "the liver differs from place to place";
}

TEST(TissueLaw, SlopeAlongTheSurfaceIsThatOfTheEnergy) {
  const Scene varied = shipped("liver", {kLinear});
  const contact::SurfaceView mesh = varied.organ_mesh.view();
  for (const char* kind : {"rhombus", "disc_stack", "hex_sheet"}) {
    const auto law = made(varied, kind);
    double largest_N = 0.0;
    int compared = 0;
    for (std::uint32_t t = 5; t < mesh.triangle.size(); t += 311) {
      const auto at = [&](double a, double b) {
        return law->contact_law().respond(
            {.surface_point = {t, {1.0 - a - b, a, b}}, .indentation_m = 0.005});
      };
      const contact::TriangleCorners& corner = mesh.triangle[t];
      const double e = 1e-3;
      const Vec3 ab_m = mesh.vertex_m[corner[1]] - mesh.vertex_m[corner[0]];
      const Vec3 ac_m = mesh.vertex_m[corner[2]] - mesh.vertex_m[corner[0]];
      const Vec3 slope_N = at(0.3, 0.3).slope_N;
      const double along_ab_J = at(0.3 + e, 0.3).law.energy_J - at(0.3 - e, 0.3).law.energy_J;
      const double along_ac_J = at(0.3, 0.3 + e).law.energy_J - at(0.3, 0.3 - e).law.energy_J;
      const double middle_J = at(0.3, 0.3).law.energy_J;
      const double ahead_J = at(0.3 + e, 0.3 + e).law.energy_J - middle_J;
      const double behind_J = middle_J - at(0.3 - e, 0.3 - e).law.energy_J;
      if (std::abs(ahead_J - behind_J) > 1e-13) continue;  // a curve of the family lies here
      EXPECT_NEAR(along_ab_J / (2 * e), dot(slope_N, ab_m), 1e-10);
      EXPECT_NEAR(along_ac_J / (2 * e), dot(slope_N, ac_m), 1e-10);
      largest_N = std::max(largest_N, norm(slope_N));
      ++compared;
    }
    EXPECT_GT(largest_N, 1e-3) << kind;
    EXPECT_GT(compared, 15) << kind;
  }
}

TEST(TissueLaw, RefusesTipsOfTwoSizesWhereTheMapKnowsOne) {
  Scene liver = shipped("liver", {"varies_by_place=false"});
  liver.tool.spheres[1].radius_m = 0.005;
  const std::string words = "radii of 0.004 and 0.005 m";
  EXPECT_NE(refusal(liver, "compliance").find(words), std::string::npos);
  EXPECT_NE(refusal(liver, "rhombus").find(words), std::string::npos);
  liver.laws.of<indent::RhombusParameters>().area_m2 = 0.0;
  EXPECT_EQ(refusal(liver, "rhombus"), "") << "one chain knows no tip";
  liver.varies_by_place = true;
  EXPECT_NE(refusal(liver, "rhombus").find(words), std::string::npos);
}

}  // namespace tact::model::scene::tissue_law_test
