// SPDX-License-Identifier: Apache-2.0
#include "hal/delta/delta_dynamics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hal/delta/delta_frame.h"
#include "hal/sim/sim_delta_model.h"

namespace tact::hal::delta::delta_dynamics_test {

using sim::kGeometry;
using sim::kMasses;
const DeltaKinematics kDelta(kGeometry);
constexpr Vec3 kGravity{3.0, -5.0, 7.0};
constexpr Vec3 kPlaces[] = {{0.0, 0.0, 0.345}, {0.1, -0.05, 0.25}, {-0.12, 0.12, 0.45}};

TEST(DeltaDynamics, GravityEnergyIsThatOfEveryBodyAtItsCentre) {
  // platform at p, arm at its centre of mass, each pair of rods halfway from elbow to platform
  // joint
  const auto energy_J = [](const Vec3& p) {
    const Joints theta = kDelta.inverse(p).theta_rad;
    Vec3 moment = 0.20 * p;
    for (std::size_t i = 0; i < 3; ++i) {
      const double phi = kGeometry.azimuth_rad[i];
      const auto on_arm = [&](double length_m) {
        const double r = 0.180 + length_m * std::cos(theta[i]);
        return Vec3{r * std::cos(phi), r * std::sin(phi), length_m * std::sin(theta[i])};
      };
      const Vec3 platform_joint = p + Vec3{0.050 * std::cos(phi), 0.050 * std::sin(phi), 0.0};
      moment += 0.25 * on_arm(0.090) + 0.08 * 0.5 * (on_arm(0.260) + platform_joint);
    }
    return -dot(kGravity, moment);
  };
  const auto law_J = [](const Vec3& p) {
    return gravity_energy_J(kGeometry, kMasses, kDelta.pose(p, kDelta.inverse(p).theta_rad),
                            kGravity);
  };
  EXPECT_NEAR(law_J(kPlaces[1]) - law_J(kPlaces[0]), energy_J(kPlaces[1]) - energy_J(kPlaces[0]),
              1e-14);
  EXPECT_NEAR(law_J(kPlaces[2]) - law_J(kPlaces[0]), energy_J(kPlaces[2]) - energy_J(kPlaces[0]),
              1e-14);
}

TEST(DeltaDynamics, GravityTorqueIsTheSlopeOfGravityEnergy) {
  const double h = 1e-5;
  for (const Vec3& p : kPlaces) {
    const Joints theta = kDelta.inverse(p).theta_rad;
    const Joints torque_Nm =
        gravity_torques_Nm(kGeometry, kMasses, kDelta.pose(p, theta), kGravity);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto energy_J = [&](double step) {
        Joints moved = theta;
        moved[i] += step;
        return gravity_energy_J(kGeometry, kMasses, kDelta.pose(kDelta.forward(moved).far_m, moved),
                                kGravity);
      };
      EXPECT_NEAR(torque_Nm[i], (energy_J(h) - energy_J(-h)) / (2.0 * h), 1e-9);
    }
  }
}

TEST(DeltaDynamics, DrivesHoldTheDeviceAndPushAsFarAsAJointMay) {
  const Vec3 force_N{2.0, -3.0, 1.0};
  for (const Vec3& p : kPlaces) {
    const DeltaPose pose = kDelta.pose(p, kDelta.inverse(p).theta_rad);
    const Joints held_Nm =
        gravity_torques_Nm(kGeometry, kMasses, pose, direction_D(kGravity_W_mps2));
    const Joints pushed_Nm = joint_torques_Nm(pose, force_N);
    const Joints free_Nm =
        drive_torques_Nm(kGeometry, kMasses, pose, direction_D(kGravity_W_mps2), force_N, 1e3);
    const Joints tight_Nm = drive_torques_Nm(kGeometry, kMasses, pose, direction_D(kGravity_W_mps2),
                                             100.0 * force_N, 7.4);
    double most_Nm = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(free_Nm[i], held_Nm[i] + pushed_Nm[i]);
      const std::size_t j = (i + 1) % 3;  // the direction stays
      EXPECT_NEAR((tight_Nm[i] - held_Nm[i]) * pushed_Nm[j],
                  (tight_Nm[j] - held_Nm[j]) * pushed_Nm[i], 1e-9);
      most_Nm = std::max(most_Nm, std::abs(tight_Nm[i]));
    }
    EXPECT_NEAR(most_Nm, 7.4, 1e-12);
  }
}

TEST(DeltaDynamics, ApparentMassCarriesTheEnergyOfJointsAndPlatform) {
  const Vec3 v{0.3, -0.2, 0.5};
  for (const Vec3& p : kPlaces) {
    const DeltaPose pose = kDelta.pose(p, kDelta.inverse(p).theta_rad);
    const Joints rate = joint_rates_radps(pose, v);
    const double turning_J = 0.5 * joint_inertia_kgm2(kGeometry, kMasses) *
                             (rate[0] * rate[0] + rate[1] * rate[1] + rate[2] * rate[2]);
    const double moving_J = 0.5 * (kMasses.platform_kg + kMasses.forearm_kg) * dot(v, v);
    const double mass_J = 0.5 * dot(v, task_inertia_kg(kGeometry, kMasses, pose) * v);
    EXPECT_NEAR(mass_J, turning_J + moving_J, 1e-15);
  }
}

TEST(DeltaDynamics, TheExampleDeviceWeighsHalfAKilogramInTheCentre) {
  const Vec3 centre{0.0, 0.0, 0.345};
  const auto mass_kg = model::singular_values(
      task_inertia_kg(kGeometry, kMasses, kDelta.pose(centre, kDelta.inverse(centre).theta_rad)));
  EXPECT_LE(mass_kg[0], 0.60);
  EXPECT_GE(mass_kg[2], 0.48);
}

}  // namespace tact::hal::delta::delta_dynamics_test
