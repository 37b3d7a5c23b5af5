// SPDX-License-Identifier: Apache-2.0
// The figure's arm on the scene's own motion: it holds the tool in every frame, by either rule.
#include "tools/tracking_bench/figure_work.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/mesh_files.h"
#include "tools/tracking_bench/tool_motion.h"

namespace tact::tools::tracking_bench::figure_work_test {

const std::string kScene = TACT_SOURCE_DIR "/model/scenes/maintenance.toml";
const std::string kTracking = TACT_SOURCE_DIR "/model/scenes/maintenance.tracking.toml";
constexpr double kFrames_Hz = 60.0;
const Eigen::Vector3d kGrip_m(0.0, 0.0, 0.120);

std::vector<MotionFrame> motion(double seconds) {
  const auto scene = model::scene::load_scene(kScene, {});
  EXPECT_TRUE(scene) << scene.error().sentence;
  const auto input = load_figure_input(kTracking);
  EXPECT_TRUE(input) << input.error().sentence;
  auto frames = figure_motion(*scene, *input, seconds, kFrames_Hz);
  EXPECT_TRUE(frames) << frames.error().sentence;
  return *frames;
}

TEST(FigureWork, TheMotionIsTheScenesHandAndItsTracker) {
  const auto frames = motion(30.0);
  ASSERT_EQ(frames.size(), 1800u);
  double low_m = 1.0, high_m = -1.0;
  int lost = 0, tracked = 0;
  for (const MotionFrame& frame : frames) {
    low_m = std::min(low_m, frame.tool.position_m.z());
    high_m = std::max(high_m, frame.tool.position_m.z());
    const host::tracking::BodyState waist = frame.bodies[host::tracking::BodyRole::kWaist].state;
    lost += waist == host::tracking::BodyState::kLost;
    tracked += waist == host::tracking::BodyState::kTracked;
  }
  EXPECT_LT(low_m, -0.003) << "it presses the gasket";
  EXPECT_GT(low_m, -0.006);
  EXPECT_NEAR(high_m, 0.022, 0.003) << "from its home";
  EXPECT_NEAR(lost / kFrames_Hz, 0.75, 0.1) << "hidden for 1.2 s, lost after 0.5";
  EXPECT_GT(tracked, 1600);
}

TEST(FigureWork, TheHandTakesTheToolByItsHandle) {
  const auto scene = model::scene::load_scene(kScene, {});
  EXPECT_NEAR(
      (host::figure::grip_m(model::mesh::summarize(scene->tool_mesh).high_m.z) - kGrip_m).norm(),
      0.0, 1e-9);
}

TEST(FigureWork, BothRulesHoldTheToolInEveryFrameAndTheShoulderFirstTurnsHalfOfTheJoints) {
  const auto frames = motion(30.0);
  const FigureWork first = measure_figure(frames, kGrip_m, host::figure::RootRule::kSubRootFirst);
  const FigureWork whole =
      measure_figure(frames, kGrip_m, host::figure::RootRule::kAlwaysFullChain);
  EXPECT_EQ(first.unreached, 0);
  EXPECT_EQ(whole.unreached, 0);
  EXPECT_LT(first.worst_error_m, 0.5e-3);
  EXPECT_LT(whole.worst_error_m, 0.5e-3);
  EXPECT_LE(first.rms_error_m, whole.rms_error_m) << "no worse an error";
  EXPECT_GE(whole.updates, 2 * first.updates);
  EXPECT_LT(first.full_chain, 18) << "the tool is within the arm's reach";
  EXPECT_EQ(whole.full_chain, 1800);
}

TEST(FigureWork, CcdHoldsTheToolWhereTheFormulaAloneMissesIt) {
  const auto far = made_up_motion(far_tool_at, kReach_s, kFrames_Hz),
             turned = made_up_motion(turned_tool_at, kReach_s, kFrames_Hz);
  for (const auto* motion : {&far, &turned}) {
    const FigureWork alone =
                         measure_figure(*motion, kGrip_m, host::figure::RootRule::kFormulaAlone),
                     ccd = measure_figure(*motion, kGrip_m, host::figure::RootRule::kSubRootFirst);
    EXPECT_EQ(alone.sweeps, 0);
    EXPECT_GT(alone.unreached, 200);
    EXPECT_GT(alone.worst_error_m, 0.02);
    EXPECT_GT(ccd.sweeps, 200);
    EXPECT_EQ(ccd.unreached, 0);
    EXPECT_LE(ccd.worst_error_m, host::figure::kGripTolerance_m);
    // Beyond the arm the trunk bends; for the wrist's limit it does not.
    EXPECT_EQ(ccd.full_chain > 0, motion == &far);
  }
}

TEST(FigureWork, CountsTheSameInEveryRun) {
  const FigureWork a = measure_figure(motion(3.0), kGrip_m, host::figure::RootRule::kSubRootFirst);
  const FigureWork b = measure_figure(motion(3.0), kGrip_m, host::figure::RootRule::kSubRootFirst);
  EXPECT_GT(a.updates, 100);
  EXPECT_EQ(a.updates, b.updates);
  EXPECT_EQ(a.sweeps, b.sweeps);
}

TEST(FigureWork, RefusesWhatMakesNoMotionInOneLine) {
  const auto input = load_figure_input(kTracking);
  ASSERT_TRUE(input);
  auto scene = model::scene::load_scene(kScene, {});
  scene->device.kind = "falcon";
  EXPECT_FALSE(figure_motion(*scene, *input, 1.0, kFrames_Hz));
  EXPECT_FALSE(load_figure_input(kScene));
  EXPECT_FALSE(load_figure_input("/nowhere.tracking.toml"));
}

TEST(FigureWork, TheProgramTellsItAsJson) {
  const tests::TempDirectory temp;
  const tests::Ran ran = tests::run_apart(temp, "tact-figure-bench", kScene + " --json");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["shoulder_first"]["frames"], 1800);
  EXPECT_GE(json["updates_ratio"], 2.0);
  EXPECT_EQ(json["reach"]["far"]["with_ccd"]["unreached_frames"], 0);
  EXPECT_GT(json["reach"]["turned"]["formula_alone"]["unreached_frames"], 0);
}

}  // namespace tact::tools::tracking_bench::figure_work_test
