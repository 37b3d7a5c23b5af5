// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/falcon_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/no_alloc.h"

namespace tact::hal::falcon::falcon_kinematics_test {

const FalconKinematics kFalcon;

std::vector<model::Vec3> grip_points() {
  std::vector<model::Vec3> points;
  for (double z = 0.080; z <= 0.170; z += 0.015) {
    for (double a = 0.0; a < 6.2; a += 0.7)
      for (const double r : {0.0, 0.02, 0.04})
        points.push_back({r * std::cos(a), r * std::sin(a), z});
  }
  return points;
}

TEST(FalconKinematics, ForwardFromHomeUndoesInverse) {
  for (const model::Vec3& p : grip_points()) {
    const FalconInverse legs = kFalcon.inverse(p);
    ASSERT_TRUE(legs.reachable);
    const FalconForward forward = kFalcon.forward(legs.thigh_rad, kFalconHome_m);
    ASSERT_TRUE(forward.solved) << p.x << " " << p.y << " " << p.z;
    EXPECT_LT(norm(forward.position_m - p), 1e-10);
  }
}

TEST(FalconKinematics, RateRowsAreTheSlopeOfInverse) {
  const double h = 1e-6;
  for (const model::Vec3& p : grip_points()) {
    const model::Mat3 k = kFalcon.joint_rate_matrix(kFalcon.inverse(p));
    for (const model::Vec3& along :
         {model::Vec3{1.0, 0.0, 0.0}, model::Vec3{0.0, 1.0, 0.0}, model::Vec3{0.0, 0.0, 1.0}}) {
      const delta::Joints more = kFalcon.inverse(p + h * along).thigh_rad;
      const delta::Joints less = kFalcon.inverse(p - h * along).thigh_rad;
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(dot(k.row[i], along), (more[i] - less[i]) / (2.0 * h), 1e-6);
    }
  }
}

TEST(FalconKinematics, TorquesTimesRatesAreForceTimesVelocity) {
  const model::Vec3 force_N{1.0, -4.0, 6.0}, velocity_mps{0.1, 0.2, -0.3};
  for (const model::Vec3& p : grip_points()) {
    const model::Mat3 k = kFalcon.joint_rate_matrix(kFalcon.inverse(p));
    const delta::Joints torque_Nm = falcon_torques_Nm(k, force_N);
    const model::Vec3 rates = k * velocity_mps;
    EXPECT_NEAR(dot(model::Vec3{torque_Nm[0], torque_Nm[1], torque_Nm[2]}, rates),
                dot(force_N, velocity_mps), 1e-13);
  }
}

TEST(FalconKinematics, CountsAndAnglesAgree) {
  EXPECT_NEAR(falcon_thigh_rad(0.0), 35.0 * 3.14159265358979 / 180.0, 1e-14);
  EXPECT_NEAR(falcon_counts(falcon_thigh_rad(-735.0)), -735.0, 1e-9);
}

TEST(FalconKinematics, BadAnglesKeepTheStartAndSayUnsolved) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const delta::Joints bad[] = {
      {nan, 0.5, 0.5}, {40.0, -40.0, 40.0}, {std::numeric_limits<double>::infinity(), 0.0, 0.0}};
  for (const delta::Joints& angles : bad) {
    const FalconForward forward = kFalcon.forward(angles, kFalconHome_m);
    EXPECT_FALSE(forward.solved);
    EXPECT_EQ(forward.position_m, kFalconHome_m);
  }
  EXPECT_FALSE(kFalcon.inverse({nan, 0.0, 0.1}).reachable);
  EXPECT_FALSE(kFalcon.inverse({0.0, 0.0, 0.4}).reachable);
  EXPECT_FALSE(kFalcon.forward({0.6, 0.6, 0.6}, {nan, nan, nan}).solved);
}

TEST(FalconKinematics, LeavesTheHeapAlone) {
  tests::NoAlloc guard;
  (void)kFalcon.forward({0.6, 0.5, 0.7}, kFalconHome_m);
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::hal::falcon::falcon_kinematics_test
