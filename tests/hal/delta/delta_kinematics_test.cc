// SPDX-License-Identifier: Apache-2.0
#include "hal/delta/delta_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "hal/sim/sim_delta_model.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::delta::delta_kinematics_test {

const DeltaKinematics kDelta(sim::kGeometry);
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Points of the workspace cylinder, the same in every run.
std::vector<Vec3> workspace_points(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double r = 0.18 * std::sqrt(unit(random)), a = 6.283 * unit(random);
    points.push_back({r * std::cos(a), r * std::sin(a), 0.195 + 0.3 * unit(random)});
  }
  return points;
}
DeltaPose pose_at(const Vec3& p) { return kDelta.pose(p, kDelta.inverse(p).theta_rad); }
double dot3(const Joints& a, const Joints& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

TEST(DeltaKinematics, ForwardUndoesInverse) {
  for (const Vec3& p : workspace_points(500)) {
    const DeltaForward forward = kDelta.forward(kDelta.inverse(p).theta_rad);
    ASSERT_TRUE(forward.solved);
    EXPECT_LT(norm(forward.far_m - p), 1e-14);
  }
}

TEST(DeltaKinematics, OnTheAxisAllArmsAgreeWithPenAndPaper) {
  // Arm level: elbow at R + la = 0.39 from the axis, rod 0.4, so z = sqrt(0.16 - 0.1521).
  const double z = std::sqrt(0.4 * 0.4 - 0.39 * 0.39);
  for (const double theta : kDelta.inverse({0.0, 0.0, z}).theta_rad) EXPECT_NEAR(theta, 0.0, 1e-15);
  EXPECT_NEAR(kDelta.forward({0.0, 0.0, 0.0}).far_m.z, z, 1e-15);
}

TEST(DeltaKinematics, EveryRodKeepsItsLength) {
  for (const Vec3& p : workspace_points(50)) {
    const Joints theta = kDelta.inverse(p).theta_rad;
    for (const Vec3& rod : kDelta.pose(p, theta).rod_m) EXPECT_NEAR(norm(rod), 0.4, 1e-15);
  }
}

TEST(DeltaKinematics, JacobianIsTheSlopeOfForward) {
  const double h = 1e-6;
  for (const Vec3& p : workspace_points(20)) {
    const Joints theta = kDelta.inverse(p).theta_rad;
    const Mat3 columns = transpose(jacobian(pose_at(p)));
    for (std::size_t i = 0; i < 3; ++i) {
      Joints more = theta, less = theta;
      more[i] += h;
      less[i] -= h;
      const Vec3 slope = (kDelta.forward(more).far_m - kDelta.forward(less).far_m) / (2.0 * h);
      EXPECT_LT(norm(slope - columns.row[i]), 1e-9);
    }
  }
}

TEST(DeltaKinematics, TorquesTimesRatesAreForceTimesVelocity) {
  for (const Vec3& p : workspace_points(50)) {
    const DeltaPose pose = pose_at(p);
    const Vec3 force_N{3.0, -7.0, 11.0}, velocity_mps{-0.2, 0.5, 0.3};
    const double hand_W = dot(force_N, velocity_mps);
    const double joints_W =
        dot3(joint_torques_Nm(pose, force_N), joint_rates_radps(pose, velocity_mps));
    EXPECT_NEAR(joints_W, hand_W, 1e-13);
  }
}

TEST(DeltaKinematics, DriftIsTheJointAccelerationOfAStraightEvenMotion) {
  const Vec3 v{0.4, -0.3, 0.6};
  const double h = 1e-4;
  for (const Vec3& p : workspace_points(20)) {
    const Joints drift = joint_drift_radps2(pose_at(p), v);
    const Joints before = kDelta.inverse(p - h * v).theta_rad;
    const Joints here = kDelta.inverse(p).theta_rad;
    const Joints after = kDelta.inverse(p + h * v).theta_rad;
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(drift[i], (after[i] - 2.0 * here[i] + before[i]) / (h * h), 2e-5);
  }
}

TEST(DeltaKinematics, TwentyNewtonNeedAtMost5Nm82) {
  double most_Nm = 0.0;
  for (const Vec3& p : workspace_points(2000)) {
    // largest torque of joint i over all directions: 20 N times the length of column i of J
    for (const Vec3& column : transpose(jacobian(pose_at(p))).row)
      most_Nm = std::max(most_Nm, 20.0 * norm(column));
  }
  EXPECT_LE(most_Nm, 5.83);
  EXPECT_GE(most_Nm, 5.5);
}

TEST(DeltaKinematics, BadGeometryAndNanGiveNoPoseInsteadOfNan) {
  EXPECT_FALSE(kDelta.inverse({0.0, 0.0, 0.86}).reachable);
  EXPECT_FALSE(kDelta.inverse({kNan, 0.0, 0.3}).reachable);
  EXPECT_FALSE(kDelta.forward({kNan, 0.0, 0.0}).solved);
  DeltaGeometry short_rods = sim::kGeometry;
  short_rods.forearm_m = 0.1;  // cannot meet
  EXPECT_FALSE(DeltaKinematics(short_rods).forward({0.0, 0.0, 0.0}).solved);
  DeltaGeometry all_on_a_line = sim::kGeometry;
  all_on_a_line.azimuth_rad = {0.0, 0.0, 0.0};
  EXPECT_FALSE(DeltaKinematics(all_on_a_line).forward({0.1, 0.1, 0.2}).solved);
  EXPECT_EQ(kDelta.forward({kNan, 0.0, 0.0}).far_m, Vec3{});
}

TEST(DeltaKinematics, RodsThatSpanNoSpaceMakeNoForce) {
  DeltaPose pose = pose_at({0.0, 0.0, 0.345});
  pose.rod_m[2] = pose.rod_m[0] + pose.rod_m[1];
  EXPECT_EQ(joint_torques_Nm(pose, {1.0, 2.0, 3.0}), (Joints{0.0, 0.0, 0.0}));
}

TEST(DeltaKinematics, SaturationScalesAllJointsTogether) {
  EXPECT_EQ(saturation_ratio({1.0, 0.0, 0.0}, {1.0, -2.0, 0.5}, 5.0), 1.0);
  // joint 0 has 4 of the wanted 8 left, joint 1 has 6 of 8 on the other side
  EXPECT_DOUBLE_EQ(saturation_ratio({1.0, 1.0, 0.0}, {8.0, -8.0, 0.0}, 5.0), 0.5);
  EXPECT_EQ(saturation_ratio({6.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 5.0), 0.0);
  EXPECT_EQ(saturation_ratio({0.0, 0.0, 0.0}, {kNan, 0.0, 0.0}, 5.0), 0.0);
  EXPECT_EQ(saturation_ratio({kNan, 0.0, 0.0}, {1.0, 0.0, 0.0}, 5.0), 0.0);
  EXPECT_EQ(saturation_ratio({}, {std::numeric_limits<double>::infinity(), 0.0, 0.0}, 5.0), 0.0);
}

TEST(DeltaKinematics, LeavesTheHeapAlone) {
  tests::NoAlloc guard;
  const DeltaInverse inverse = kDelta.inverse({0.01, 0.02, 0.3});
  (void)kDelta.forward(inverse.theta_rad);
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::hal::delta::delta_kinematics_test
