// SPDX-License-Identifier: Apache-2.0
// What tactd refuses before the loop starts: a law that is too slow for the tick.
#include "firmware/admission/tick_budget.h"

#include <gtest/gtest.h>

#include <array>
#include <bitset>

#include "tests/support/test_scene.h"

namespace tact::firmware::admission::tick_budget_test {

bool has(const model::Error& error, const std::string& part) {
  return error.message.find(part) != std::string::npos;
}

TEST(TickBudget, RefusesALawThatCannotKeepItsBudget) {
  model::scene::Scene scene = tests::make_plate_scene();
  const auto tissue = model::scene::make_tissue(scene);
  ASSERT_TRUE(tissue) << tissue.error().message;
  const auto free = check_budget(scene, **tissue, {});
  ASSERT_TRUE(free) << free.error().message;
  EXPECT_EQ(free->budget_us, 500.0) << "without a tolerance: half a period";
  EXPECT_GT(free->measured.median_us, 0.0);
  EXPECT_LE(free->measured.median_us, free->measured.p999_us);
  EXPECT_EQ(free->checked_us, free->measured.median_us);
  scene.tolerance = {.force_error_ratio = 0.07, .shape_error_ratio = 0.2, .tick_budget_us = 1e-4};
  const auto refused = check_budget(scene, **tissue, {});
  ASSERT_FALSE(refused);
  for (const char* part : {"tolerance.tick_budget_us is 0.0001", "tact-lab plan", "median"})
    EXPECT_TRUE(has(refused.error(), part)) << refused.error().message;
}

TEST(TickBudget, WithHardRealTimeTheTailIsJudged) {
  model::scene::Scene scene = tests::make_plate_scene();
  const auto tissue = model::scene::make_tissue(scene);
  ASSERT_TRUE(tissue) << tissue.error().message;
  scene.tolerance = {.force_error_ratio = 0.07, .shape_error_ratio = 0.2, .tick_budget_us = 1e6};
  const auto checked = check_budget(scene, **tissue, pc::RtSettings{});
  ASSERT_TRUE(checked) << checked.error().message;
  EXPECT_EQ(checked->checked_us, checked->measured.p999_us);
  scene.tolerance->tick_budget_us = 1e-4;
  const auto refused = check_budget(scene, **tissue, pc::RtSettings{});
  ASSERT_FALSE(refused);
  EXPECT_TRUE(has(refused.error(), "(p99.9)")) << refused.error().message;
}

// A patch that stays where it is costs less than one that follows the hand: count what is asked.
class AskedLaw final : public model::contact::ContactLaw {
 public:
  model::contact::ContactLawResponse respond(
      const model::contact::Indentation& in) RT_SAFE override {
    asked[in.surface_point.triangle % asked.size()] = true;
    if (in.indentation_m > 0.0) ++presses[in.sphere];
    return {.law = {.force_N = 100.0 * in.indentation_m, .stiffness_N_per_m = 100.0}};
  }
  void leave(std::size_t) RT_SAFE override {}
  void cut(const model::contact::BladeSweep& sweep) RT_SAFE override {
    moved = moved || !(sweep.from_a_m == sweep.to_a_m && sweep.from_b_m == sweep.to_b_m);
  }
  void advance() RT_SAFE override {}
  std::size_t profile(const model::contact::Indentation&,
                      std::span<double>) const RT_SAFE override {
    return 0;
  }
  double ring_pitch_m() const RT_SAFE override { return 1e-3; }

  std::bitset<4096> asked;
  std::array<int, model::contact::kMaxSpheres> presses{};
  bool moved = false;
};

TEST(TickBudget, MeasuresAWholeTickInMotionAndContact) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.tool.spheres = {{{0, -0.004, 0}, 0.004}, {{0, 0.004, 0}, 0.004}};
  scene.tool.blade = model::contact::Blade{.a_m = {}, .b_m = {0, 0, 0.01}};
  const auto tissue = model::scene::make_tissue(scene);
  ASSERT_TRUE(tissue) << tissue.error().message;
  AskedLaw law;
  model::contact::ContactScene contact = (*tissue)->contact_scene();
  contact.law = &law;
  const TickTime time = measure_tick(scene, contact, 0.001);
  EXPECT_GT(law.asked.count(), 10u) << "triangles on the way";
  EXPECT_GT(law.presses[0], 1000) << "most of 4000 ticks press";
  EXPECT_GT(law.presses[1], 1000) << "with each sphere";
  EXPECT_TRUE(law.moved) << "the blade is with the tool, armed";
  EXPECT_GT(time.median_us, 0.0);
  EXPECT_LE(time.median_us, time.p999_us);
  EXPECT_LE(time.p999_us, time.longest_us);
}

}  // namespace tact::firmware::admission::tick_budget_test
