// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/plan/reference_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tools/reference/self_check/block.h"

namespace tact::tools::reference::reference_plan_test {

ReferencePlan plan() {
  auto organ = make_block(0.05, 0.05, {.youngs_modulus_Pa = 1000.0, .poisson_ratio = 0.45});
  EXPECT_TRUE(organ) << organ.error().message;
  return {.organ = std::move(*organ),
          .mesh_name = "block.obj",
          .tool_radius_m = 5e-3,
          .sites = {0, 3},
          .depths_m = {1e-3, 2e-3, 9e-3},
          .large_strain_sites = {3},
          .level = 2};
}

/// A made-up answer: F = d, 1 % more at the coarser level, 5 % more at the least depth.
ground_truth::ReferenceCase answer(const Indentation& what, const ReferencePlan& p) {
  const bool coarse = what.level < (what.large_strain ? kCoarsestLevel : p.level);
  const double more = coarse ? (what.depth_m == p.depths_m.front() ? 1.05 : 1.01) : 1.0;
  return {.depth_m = what.depth_m,
          .large_strain = what.large_strain,
          .force_N = what.depth_m * more,
          .contact_radius_m = 1e-3,
          .profile_m = {what.depth_m, 0.5 * what.depth_m}};
}

ground_truth::ReferenceData made_up(const ReferencePlan& p) {
  std::vector<std::optional<ground_truth::ReferenceCase>> solved;
  for (const Indentation& c : cases_of(p)) solved.push_back(answer(c, p));
  return assemble(p, solved, "by hand");
}

TEST(ReferencePlan, SolvesEveryDepthAndTheCoarseOnesForTheError) {
  const ReferencePlan p = plan();
  const auto cases = cases_of(p);
  // A site: three presses, one pull; least, largest and pull coarser. With large strain: three
  // presses and two pulls, since 9 mm is too far for one; least and largest of both coarser.
  EXPECT_EQ(cases.size(), 2U * 7U + 5U + 4U);
  for (const Indentation& c : cases) {
    if (!c.large_strain) continue;
    EXPECT_EQ(c.vertex, 3U);
    EXPECT_TRUE(c.level == kCoarsestLevel || c.depth_m != 2e-3);
    EXPECT_GT(c.depth_m, -3e-3);
  }
}

TEST(ReferencePlan, PutsTheFileTogether) {
  const ReferencePlan p = plan();
  const ground_truth::ReferenceData data = made_up(p);
  ASSERT_EQ(data.sites.size(), 2U);
  ASSERT_EQ(data.sites[0].cases.size(), 6U);
  ASSERT_EQ(data.sites[1].cases.size(), 11U);
  const auto& cases = data.sites[0].cases;
  const double depths_m[] = {1e-3, 2e-3, 9e-3, -1e-3, -2e-3, -9e-3};
  const double errors[] = {0.05, 0.05, 0.01, 0.01, 0.01, 0.01};  // of the nearer depth
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_DOUBLE_EQ(cases[i].depth_m, depths_m[i]);
    EXPECT_NEAR(cases[i].force_N, depths_m[i], 1e-15) << "pull is one solve, scaled";
    EXPECT_NEAR(cases[i].profile_m[1], 0.5 * depths_m[i], 1e-15);
    EXPECT_NEAR(cases[i].force_error_ratio, 7.0 / 3.0 * errors[i], 1e-12) << i;
  }
  // Its own; where a bond is drawn out the error falls slower.
  const double large_errors[] = {7.0 / 3.0 * 0.05, 7.0 / 3.0 * 0.05, 7.0 / 3.0 * 0.01, 0.04, 0.04};
  for (std::size_t i = 0; i < 5; ++i) {
    const ground_truth::ReferenceCase& c = data.sites[1].cases[6 + i];
    EXPECT_TRUE(c.large_strain);
    EXPECT_DOUBLE_EQ(c.depth_m, depths_m[i]);
    EXPECT_NEAR(c.force_error_ratio, large_errors[i], 1e-12) << i;
  }
  EXPECT_EQ(data.sites[0].direction, (model::Vec3{0.0, 0.0, -1.0}));
}

TEST(ReferencePlan, ALargeStrainThatHasNoSolutionIsLeftOut) {
  const ReferencePlan p = plan();
  std::vector<std::optional<ground_truth::ReferenceCase>> solved;
  for (const Indentation& c : cases_of(p)) {
    const bool no_end = c.large_strain && c.depth_m == 9e-3;
    solved.push_back(no_end ? std::nullopt : std::optional(answer(c, p)));
  }
  const auto data = assemble(p, solved, "by hand");
  const auto& cases = data.sites[1].cases;
  ASSERT_EQ(cases.size(), 10U);
  EXPECT_DOUBLE_EQ(cases[7].depth_m, 2e-3);
  EXPECT_NEAR(cases[7].force_error_ratio, 7.0 / 3.0 * 0.05, 1e-12) << "of the end that is left";
  EXPECT_DOUBLE_EQ(cases[8].depth_m, -1e-3);
}

TEST(ReferencePlan, OneDepthHasItsOwnError) {
  ReferencePlan p = plan();
  p.depths_m = {2e-3};
  const ground_truth::ReferenceData data = made_up(p);
  ASSERT_EQ(data.sites[0].cases.size(), 2U);
  EXPECT_NEAR(data.sites[0].cases[0].force_error_ratio, 7.0 / 3.0 * 0.05, 1e-12);
}

TEST(ReferencePlan, TheCoarsestLevelHasNoErrorThatIsKnown) {
  ReferencePlan p = plan();
  p.level = kCoarsestLevel;
  const ground_truth::ReferenceData data = made_up(p);
  for (const ground_truth::SolvedSite& site : data.sites)
    for (const ground_truth::ReferenceCase& c : site.cases)
      EXPECT_EQ(std::isnan(c.force_error_ratio), !c.large_strain) << "which has its own levels";
}

TEST(ReferencePlan, RefusesWhatCannotBeSolved) {
  const auto message = [](auto change) {
    ReferencePlan p = plan();
    change(p);
    const auto error = check(p);
    return error ? error->message : std::string("fine");
  };
  EXPECT_EQ(message([](ReferencePlan&) {}), "fine");
  EXPECT_EQ(message([](ReferencePlan& p) { p.sites = {0, 434}; }),
            "site 434 is no vertex of block.obj; they are 0 to 433");
  EXPECT_EQ(message([](ReferencePlan& p) { p.sites = {3, 217}; }),
            "site 217 lies in the held box, elastic.fixed_min_m to elastic.fixed_max_m; choose "
            "another, or "
            "move the box");
  EXPECT_EQ(message([](ReferencePlan& p) { p.sites = {0, 3, 0}; }),
            "site 0 is there twice; give it once");
  EXPECT_EQ(message([](ReferencePlan& p) { p.sites.clear(); }),
            "no site to solve; add [[reference_site]] to the scene, or give --sites");
  EXPECT_EQ(message([](ReferencePlan& p) { p.large_strain_sites = {5}; }),
            "large strain at 5, which is no site; add it to --sites");
  for (const std::vector<double>& bad : {std::vector<double>{},
                                         {0.0, 1e-3},
                                         {2e-3, 1e-3},
                                         {1e-3, 1e-3},
                                         {std::nan("")},
                                         {1e-3, std::nan("")},
                                         {std::nan(""), 1e-3},
                                         {1e-3, std::numeric_limits<double>::infinity()},
                                         {0.1}})
    EXPECT_EQ(message([&](ReferencePlan& p) { p.depths_m = bad; }),
              "--depths must rise, all above 0 and at most 0.025 m (5 tool radii); give metres: "
              "0.001,0.002");
  EXPECT_EQ(message([](ReferencePlan& p) { p.depths_m = {0.025}; }), "fine");
}

}  // namespace tact::tools::reference::reference_plan_test
