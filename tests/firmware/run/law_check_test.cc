// SPDX-License-Identifier: Apache-2.0
// What tactd refuses before the loop starts: too stiff for the device, too slow for the tick.
#include "firmware/run/law_check.h"

#include <gtest/gtest.h>

#include <bitset>

#include "tests/support/test_scene.h"

namespace tact::firmware::run::law_check_test {

hal::DeviceInfo device_with(double damping_Ns_per_m) {
  hal::DeviceInfo device;
  device.at_tool = model::DeviceAtTool{.damping_Ns_per_m = damping_Ns_per_m, .delay_s = 0.0005};
  device.damping_key = "device.sim.joint_damping_Nms_per_rad";
  return device;
}

bool has(const model::Error& error, const std::string& part) {
  return error.sentence.find(part) != std::string::npos;
}

TEST(LawCheck, RefusesAStiffnessBeyondTheDevicesLimitAndSaysWhichKeyToChange) {
  model::scene::Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  // One sphere, 100 N/m along the surface: K < b / (T/2 + t_d) = 1000 b.
  const auto fits = check_renderable(scene, *tissue, device_with(0.101));
  ASSERT_TRUE(fits) << fits.error().sentence;
  EXPECT_NEAR(fits->needed_N_per_m, 100.0, 1e-9);
  EXPECT_NEAR(fits->limit_N_per_m, 101.0, 1e-9);
  const auto refused = check_renderable(scene, *tissue, device_with(0.099));
  ASSERT_FALSE(refused);
  EXPECT_EQ(
      refused.error().sentence,
      "plate.toml: contact.sliding_stiffness_N_per_m is too stiff: 100 N/m on 1 sphere is 100 "
      "N/m, this device is stable to 99 N/m at 1000 Hz; lower it to 99 N/m or less, raise "
      "rate_Hz, or raise device.sim.joint_damping_Nms_per_rad");
  scene.tool.spheres.push_back({{}, 0.004});  // two spheres push at once
  const auto two = check_renderable(scene, *tissue, device_with(0.101));
  ASSERT_FALSE(two);
  EXPECT_TRUE(has(two.error(), "100 N/m on 2 spheres is 200 N/m")) << two.error().sentence;
  EXPECT_TRUE(has(two.error(), "to 50.5 N/m or less")) << two.error().sentence;
}

TEST(LawCheck, NamesThePullWhereItIsTheStifferOne) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.contact.sliding_stiffness_N_per_m = 1.0;
  scene.pull = {.stiffness_N_per_m = 4000.0, .limit_m = 0.01};
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  const auto refused = check_renderable(scene, *tissue, device_with(0.05));
  ASSERT_FALSE(refused);
  EXPECT_TRUE(has(refused.error(), "soften pull.stiffness_N_per_m to 50 N/m"))
      << refused.error().sentence;
}

TEST(LawCheck, NamesTheLawWhereItIsTheStifferOne) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.contact.sliding_stiffness_N_per_m = 1.0;
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  EXPECT_GT(tissue->law().stiffness_N_per_m(), 50.0);
  hal::DeviceInfo device = device_with(0.05);
  device.damping_key.clear();
  const auto refused = check_renderable(scene, *tissue, device);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(has(refused.error(), "law rhombus is too stiff")) << refused.error().sentence;
  EXPECT_TRUE(has(refused.error(), "soften [rhombus] to 50 N/m")) << refused.error().sentence;
  EXPECT_TRUE(has(refused.error(), "take a device with more damping")) << refused.error().sentence;
}

TEST(LawCheck, RefusesADeviceThatDoesNotTellItsDamping) {
  const model::scene::Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  const auto refused = check_renderable(scene, *tissue, {.name = "mute"});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().sentence,
            "device mute does not tell its damping at the tool: fill DeviceInfo::at_tool");
}

TEST(LawCheck, RefusesADampingThatLeavesTheDeviceTooLittle) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.law = model::scene::LawKind::kHuntCrossley;
  scene.contact.sliding_stiffness_N_per_m = 50.0;
  scene.tool.spheres.push_back({{}, 0.004});
  // 2 x 50 N/m need 0.1 of 0.2 N s/m, and the law takes 2 x 0.5 N x lambda
  scene.hunt_crossley = {.force_N = 0.5, .working_depth_m = 0.02, .exponent = 1.0};
  for (const double dissipation_s_per_m : {0.0, 0.09}) {
    scene.hunt_crossley.dissipation_s_per_m = dissipation_s_per_m;
    const auto tissue = std::move(*model::scene::make_tissue(scene));
    const auto fits = check_renderable(scene, *tissue, device_with(0.2));
    ASSERT_TRUE(fits) << fits.error().sentence;
    EXPECT_NEAR(fits->limit_N_per_m, 200.0 - 950.0 * dissipation_s_per_m, 1e-6) << "0.95 of d_w";
  }
  scene.hunt_crossley.dissipation_s_per_m = 0.12;
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  const auto refused = check_renderable(scene, *tissue, device_with(0.2));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().sentence,
            "plate.toml: law hunt_crossley damps too much: 0.057 N s/m on 2 spheres, where this "
            "device has 0.2 N s/m of its own and 100 N/m to show at 1000 Hz; lower the damping of "
            "[hunt_crossley] to 0.05 N s/m or less");
}

TEST(LawCheck, TellsOfAStrokeThatIsTooFastForALawWithoutInertia) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.elastic = {.youngs_modulus_Pa = 5000.0, .poisson_ratio = 0.45};
  scene.hand_site_m = {0, 0, 0};
  scene.hand_inward = {0, 0, -1};
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  // 10 mm deep, from the surface: 15/8 of 10 mm in the time, at 5 mm, where IN-2 says 109 mm/s
  const auto told = [&](double duration_s) {
    scene.hand.path = {{.time_s = 0.0, .position_m = {0, 0, 0.004}},
                       {.time_s = duration_s, .position_m = {0, 0, -0.006}},
                       {.time_s = duration_s + 0.05, .position_m = {0, 0, 0.05}}};
    return inertia_note(scene, tissue->law());
  };
  EXPECT_EQ(told(0.5), "") << "a release is not a press";
  const std::string fast = told(0.05);
  for (const char* part :
       {"plate.toml: a stroke of the hand presses with",
        "mm/s on the inertia of "
        "tissue, which this law leaves out, is more than 7 % of the force there"})
    EXPECT_NE(fast.find(part), std::string::npos) << fast;
  scene.elastic.reset();
  EXPECT_NE(told(0.02), "") << "the law's own half-space";
}

TEST(LawCheck, OfTheShippedScenesTheHeartIsPressedTooFastForItsLaw) {
  for (const std::string name : {"gum", "heart", "liver", "maintenance", "skin"}) {
    const auto scene =
        model::scene::load_scene(TACT_SOURCE_DIR "/model/scenes/" + name + ".toml", {});
    ASSERT_TRUE(scene) << scene.error().sentence;
    const auto tissue = std::move(*model::scene::make_tissue(*scene));
    const std::string note = inertia_note(*scene, tissue->law());
    EXPECT_EQ(note.empty(), name != "heart") << note;
  }
}

TEST(LawCheck, RefusesALawThatCannotKeepItsBudget) {
  model::scene::Scene scene = tests::make_plate_scene();
  const auto free = check_budget(scene, {});
  ASSERT_TRUE(free) << free.error().sentence;
  EXPECT_EQ(free->budget_us, 500.0) << "without a tolerance: half a period";
  EXPECT_GT(free->measured.median_us, 0.0);
  EXPECT_LE(free->measured.median_us, free->measured.p999_us);
  EXPECT_EQ(free->judged_us, free->measured.median_us);
  scene.tolerance = {.force_error_ratio = 0.07, .shape_error_ratio = 0.2, .tick_budget_us = 1e-4};
  const auto refused = check_budget(scene, {});
  ASSERT_FALSE(refused);
  for (const char* part : {"tolerance.tick_budget_us is 0.0001", "tact-plan", "median"})
    EXPECT_TRUE(has(refused.error(), part)) << refused.error().sentence;
}

TEST(LawCheck, WithHardRealTimeTheTailIsJudged) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.tolerance = {.force_error_ratio = 0.07, .shape_error_ratio = 0.2, .tick_budget_us = 1e6};
  const auto judged = check_budget(scene, pc::RtSettings{});
  ASSERT_TRUE(judged) << judged.error().sentence;
  EXPECT_EQ(judged->judged_us, judged->measured.p999_us);
  scene.tolerance->tick_budget_us = 1e-4;
  const auto refused = check_budget(scene, pc::RtSettings{});
  ASSERT_FALSE(refused);
  EXPECT_TRUE(has(refused.error(), "(p99.9)")) << refused.error().sentence;
}

// A patch that stays where it is costs less than one that follows the hand: count what is asked.
class AskedLaw final : public model::contact::SiteLaw {
 public:
  model::contact::SiteResponse respond(const model::contact::Indentation& in) RT_SAFE override {
    asked[in.place.triangle % asked.size()] = true;
    return {};
  }
  void leave(std::size_t) RT_SAFE override {}
  void cut(const model::contact::BladeSweep& sweep) RT_SAFE override {
    ++cuts;
    moved = moved || !(sweep.from_a_m == sweep.to_a_m && sweep.from_b_m == sweep.to_b_m);
  }
  void advance() RT_SAFE override {}
  std::size_t profile(const model::contact::Indentation&,
                      std::span<double>) const RT_SAFE override {
    return 0;
  }
  double ring_pitch_m() const RT_SAFE override { return 1e-3; }

  std::bitset<4096> asked;
  int cuts = 0;
  bool moved = false;
};

TEST(LawCheck, MeasuresAContactThatWalksAndABladeThatCutsNothing) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.tool.blade = model::contact::Blade{.a_m = {}, .b_m = {0, 0, 0.01}};
  AskedLaw law;
  const LawTime time = measure_law(scene, law, 0.001);
  EXPECT_GT(law.asked.count(), 10u) << "triangles on the way";
  EXPECT_GT(law.cuts, 100);
  EXPECT_FALSE(law.moved) << "an edge that stands still cuts nothing";
  EXPECT_GT(time.median_us, 0.0);
}

}  // namespace tact::firmware::run::law_check_test
