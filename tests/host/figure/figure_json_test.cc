// SPDX-License-Identifier: Apache-2.0
#include "host/figure/figure_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace tact::host::figure::figure_json_test {

TEST(FigureJson, StaysInItsLengthForAnyFigure) {
  FigurePose pose;
  for (Eigen::Vector3d& at_m : pose.joint_m) at_m.setConstant(-1e30);
  pose.grip_m.setConstant(-1e30);
  pose.head = Eigen::Quaterniond(-0.12345678, -0.12345678, -0.12345678, -0.9);
  pose.arm = {.error_m = 1e9, .sweeps = 40, .updates = 280};
  pose.trouble = FigureTrouble::kLost;
  pose.words = "right ankle lost (a number that is none)";
  const std::string text = figure_json(pose, UINT64_MAX, false);
  EXPECT_LE(text.size(), kMaxFigureJsonBytes);
  EXPECT_GT(text.size(), kMaxFigureJsonBytes - 250) << "the bound is no larger than it must be";
  EXPECT_TRUE(nlohmann::json::accept(text));
}

TEST(FigureJson, SaysTheJointsToATenthOfAMillimetre) {
  Figure figure;
  Pose tool;
  tool.position_m = {0.01234, -0.02, 0.03};
  const FigurePose& pose = figure.update(0.0, tool, {});
  const auto json = nlohmann::json::parse(figure_json(pose, 7, true));
  EXPECT_EQ(json.at("kind"), "figure");
  EXPECT_EQ(json.at("tick"), 7);
  ASSERT_EQ(json.at("joint_m").size(), 3 * kFigureJoints);
  for (std::size_t i = 0; i < kFigureJoints; ++i) {
    for (int k = 0; k < 3; ++k) {
      const double reported_m = json["joint_m"][3 * i + static_cast<std::size_t>(k)];
      EXPECT_NEAR(reported_m, pose.joint_m[i][k], 0.51e-4);
    }
  }
  EXPECT_EQ(json.at("reached"), true);
  EXPECT_EQ(json.at("trouble"), 0);
}

TEST(FigureJson, TheSkeletonNamesJointsThatAreThere) {
  const auto json = skeleton_json(make_body_plan(1.75));
  ASSERT_EQ(json.at("joints").size(), kFigureJoints);
  EXPECT_EQ(json["joints"][json.at("hand").get<std::size_t>()], "right fingers");
  EXPECT_EQ(json["joints"][json.at("head").get<std::size_t>()], "head");
  EXPECT_EQ(json.at("capsules").size(), kCapsules);
  for (const auto& part : json["capsules"]) {
    EXPECT_LT(part.at("a").get<std::size_t>(), kFigureJoints);
    EXPECT_LT(part.at("b").get<std::size_t>(), kFigureJoints);
  }
}

}  // namespace tact::host::figure::figure_json_test
