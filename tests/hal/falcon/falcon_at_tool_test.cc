// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/falcon_at_tool.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hal/falcon/falcon_device.h"
#include "hal/falcon/falcon_kinematics.h"
#include "hal/falcon/falcon_packets.h"

namespace tact::hal::falcon::falcon_at_tool_test {

const FalconKinematics kFalcon;

FalconSettings settings() {
  FalconSettings s;
  s.joint_damping_Nms_per_rad = 0.01;
  s.joint_friction_Nm = 0.02;
  return s;
}

/// How far the grip goes when a thigh turns by h, in the direction where it goes furthest.
double reach_m_per_rad(const Vec3& p_W) {
  const Vec3 p_D = falcon_point_D(p_W);
  const double h_m = 1e-6;
  double most = 0.0;
  for (int i = 0; i < 400; ++i) {  // directions on a sphere
    const double z = 1.0 - (2.0 * i + 1.0) / 400.0, a = 2.399963 * i, r = std::sqrt(1.0 - z * z);
    const Vec3 along{r * std::cos(a), r * std::sin(a), z};
    const delta::Joints there = kFalcon.inverse(p_D + h_m * along).thigh_rad;
    const delta::Joints here = kFalcon.inverse(p_D).thigh_rad;
    const Vec3 turned{there[0] - here[0], there[1] - here[1], there[2] - here[2]};
    most = std::max(most, h_m / norm(turned));
  }
  return most;
}

TEST(FalconAtTool, StepDampingAndFrictionAreThoseOfTheWorstPose) {
  const model::DeviceAtTool at = falcon_at_tool(kFalcon, settings());
  double s = 0.0;
  for (const double x : {-0.04, -0.02, 0.0, 0.02, 0.04})
    for (int i = 0; i < 12; ++i)
      s = std::max(s,
                   reach_m_per_rad({x, 0.04 * std::cos(i * 0.5236), 0.04 * std::sin(i * 0.5236)}));
  EXPECT_NEAR(at.position_step_m, s * 6.359e-4, 0.02 * at.position_step_m);
  EXPECT_NEAR(at.damping_Ns_per_m, 0.01 / (s * s), 0.04 * at.damping_Ns_per_m);
  EXPECT_NEAR(at.friction_N, 0.02 / s, 0.02 * at.friction_N);
}

TEST(FalconAtTool, TheChipsTimerCountsWhereTheEventCharacterIsOff) {
  FalconSettings s = settings();
  EXPECT_EQ(falcon_at_tool(kFalcon, s).delay_s, 2e-3);
  s.event_character = false;
  EXPECT_EQ(falcon_at_tool(kFalcon, s).delay_s, 3e-3);
}

TEST(FalconAtTool, ForceGrowsWithSmallerGainsUpToThatOfTheDevice) {
  FalconSettings s = settings();
  const double weak_N = falcon_max_force_N(kFalcon, s);  // 10 000 words per N m: 0.41 N m at most
  EXPECT_NEAR(weak_N, 4.52, 0.05);
  s.gain_words_per_Nm = {8000.0, 8000.0, 8000.0};
  EXPECT_NEAR(falcon_max_force_N(kFalcon, s), weak_N / 0.8, 1e-9);
  s.dead_band_words = {409.5, 409.5, 409.5};
  EXPECT_NEAR(falcon_max_force_N(kFalcon, s), 0.9 * weak_N / 0.8, 1e-9);
  s.gain_words_per_Nm = {2000.0, 2000.0, 2000.0};
  EXPECT_EQ(falcon_max_force_N(kFalcon, s), kFalconMaxForce_N);
}

TEST(FalconFrame, PointsGoThereAndBack) {
  const Vec3 p_W{0.01, -0.02, 0.03};
  EXPECT_LT(norm(falcon_point_W(falcon_point_D(p_W)) - p_W), 1e-15);
  EXPECT_EQ(falcon_point_W({0.0, 0.0, 0.120}), Vec3{});
  EXPECT_EQ(falcon_direction_D({1.0, 2.0, 3.0}), (Vec3{2.0, 3.0, 1.0}));
}

TEST(FalconFrame, TheWholeWorkspaceCanBeReached) {
  for (double x = -kFalconHalfLength_m; x <= kFalconHalfLength_m + 1e-9; x += 0.01)
    for (int i = 0; i < 72; ++i)
      EXPECT_TRUE(kFalcon
                      .inverse(falcon_point_D({x, kFalconRadius_m * std::cos(i * 0.0873),
                                               kFalconRadius_m * std::sin(i * 0.0873)}))
                      .reachable);
}

}  // namespace tact::hal::falcon::falcon_at_tool_test
