// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/sim_delta_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/delta_indices.h"

namespace tact::hal::sim_delta::sim_delta_model_test {

TEST(SimDeltaModel, WorldAxesArePlacedAsTheHeaderSays) {
  // D z points at the operator (+x of W), D x up (+z), D y to the left (-y).
  EXPECT_EQ(sim::direction_W({0.0, 0.0, 1.0}), (model::Vec3{1.0, 0.0, 0.0}));
  EXPECT_EQ(sim::direction_W({1.0, 0.0, 0.0}), (model::Vec3{0.0, 0.0, 1.0}));
  EXPECT_EQ(sim::direction_W({0.0, 1.0, 0.0}), (model::Vec3{0.0, -1.0, 0.0}));
}

TEST(SimDeltaModel, TheMountingIsARotation) {
  const model::Vec3 a{1.0, 2.0, 3.0}, b{-2.0, 0.5, 1.0};
  EXPECT_EQ(sim::direction_D(sim::direction_W(a)), a);
  EXPECT_EQ(cross(sim::direction_W(a), sim::direction_W(b)),
            sim::direction_W(cross(a, b)));  // right-handed
  EXPECT_LT(norm(sim::point_D(sim::point_W(a)) - a), 1e-15);
}

TEST(SimDeltaModel, TheOriginOfTheWorldIsTheMiddleOfTheCylinder) {
  EXPECT_LT(norm(sim::point_D({}) - model::Vec3{0.0, 0.0, 0.345}), 1e-15);
  EXPECT_NEAR(sim::point_W({0.0, 0.0, 0.195}).x, -sim::kWorkspaceHalfLength_m, 1e-15);
  EXPECT_NEAR(sim::point_W({0.0, 0.0, 0.495}).x, sim::kWorkspaceHalfLength_m, 1e-15);
}

TEST(SimDeltaModel, InTheWholeCylinderPoseAndMotorsAreWithinTheirLimits) {
  const delta::DeltaKinematics delta(sim::kGeometry);
  double most_Nm = 0.0;
  for (double x = -0.150; x <= 0.1501; x += 0.030) {
    for (double a = 0.0; a < 6.28; a += 0.3) {
      for (const double r : {0.0, 0.09, 0.18}) {
        const model::Vec3 p_D = sim::point_D({x, r * std::cos(a), r * std::sin(a)});
        const delta::DeltaInverse inverse = delta.inverse(p_D);
        ASSERT_TRUE(inverse.reachable);
        EXPECT_TRUE(tests::delta_indices(delta, p_D, inverse.theta_rad).within_limits());
        for (const double theta_rad : inverse.theta_rad) {
          EXPECT_GE(theta_rad, sim::kGeometry.theta_min_rad);
          EXPECT_LE(theta_rad, sim::kGeometry.theta_max_rad);
        }
        // 20 N in the worst direction for joint i, on top of gravity, within the motors
        const delta::DeltaPose pose = delta.pose(p_D, inverse.theta_rad);
        const delta::Joints gravity_Nm = gravity_torques_Nm(
            sim::kGeometry, sim::kMasses, pose, sim::direction_D(delta::kGravity_W_mps2));
        const model::Mat3 columns = transpose(jacobian(pose));
        for (std::size_t i = 0; i < 3; ++i) {
          const double needed_Nm =
              std::abs(gravity_Nm[i]) + sim::kMaxForce_N * norm(columns.row[i]);
          EXPECT_LE(needed_Nm, sim::kMaxJointTorque_Nm);
          most_Nm = std::max(most_Nm, needed_Nm);
        }
      }
    }
  }
  EXPECT_GE(most_Nm, 0.8 * sim::kMaxJointTorque_Nm);  // and the motors are not oversized
}

}  // namespace tact::hal::sim_delta::sim_delta_model_test
