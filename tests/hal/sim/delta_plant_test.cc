// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/delta_plant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/sim/sim_delta_model.h"
#include "tests/support/delta_indices.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::sim::delta_plant_test {

constexpr double kStep_s = 0.25e-3;
constexpr model::Vec3 kStart{0.05, -0.04, 0.33};
const delta::DeltaKinematics kDelta(kGeometry);

delta::DeltaPose pose_of(const DeltaPlant& plant) {
  return kDelta.pose(plant.position_D_m(), plant.theta_rad());
}
delta::Joints gravity_Nm(const DeltaPlant& plant) {
  return gravity_torques_Nm(kGeometry, kMasses, pose_of(plant),
                            direction_D(delta::kGravity_W_mps2));
}
/// Gravity balanced, and a force on the platform besides.
delta::Joints motors_Nm(const DeltaPlant& plant, const model::Vec3& force_N) {
  delta::Joints torque_Nm = gravity_Nm(plant);
  const delta::Joints extra_Nm = joint_torques_Nm(pose_of(plant), force_N);
  for (std::size_t i = 0; i < 3; ++i) torque_Nm[i] += extra_Nm[i];
  return torque_Nm;
}

TEST(DeltaPlant, StartsAtItsSettingOrInTheMiddle) {
  EXPECT_EQ(DeltaPlant({}, kStart).position_D_m(), kStart);
  EXPECT_DOUBLE_EQ(DeltaPlant({}, {9.0, 0.0, 0.0}).position_D_m().z, 0.345);
}

TEST(DeltaPlant, AForceAcceleratesTheApparentMass) {
  DeltaPlant plant({}, kStart);
  const model::Vec3 force_N{2.0, 1.0, -3.0};
  const model::Vec3 expected_mps2 =
      inverse(task_inertia_kg(kGeometry, kMasses, pose_of(plant))) * force_N;
  plant.step(1e-6, motors_Nm(plant, force_N), {});
  EXPECT_LT(norm(plant.velocity_mps() / 1e-6 - expected_mps2), 1e-9);
}

TEST(DeltaPlant, AHeldForceMovesItAsFarAsItReallyWould) {
  // a t^2 / 2 after one step and after twenty; with x+ = x + h v+ it would be h / 2 ahead
  for (const int steps : {1, 20}) {
    DeltaPlant plant({}, kStart);
    const model::Vec3 force_N{2.0, 1.0, -3.0};
    const model::Vec3 a_mps2 =
        inverse(task_inertia_kg(kGeometry, kMasses, pose_of(plant))) * force_N;
    for (int i = 0; i < steps; ++i) plant.step(kStep_s, motors_Nm(plant, force_N), {});
    const double t_s = steps * kStep_s;
    EXPECT_LT(norm(plant.position_D_m() - kStart - 0.5 * t_s * t_s * a_mps2),
              2e-3 * 0.5 * t_s * t_s * norm(a_mps2));
  }
}

TEST(DeltaPlant, WithoutFrictionEnergyComesFromTheMotorsAlone) {
  // Coriolis terms, gravity and changing mass included: what the motors do is what the device has.
  const auto worst_error_J = [](double dt_s) {
    DeltaPlant plant({}, kStart);
    const double before_J = plant.energy_J();
    double work_J = 0.0, worst_J = 0.0;
    for (double t = 0.0; t < 0.4; t += dt_s) {
      delta::Joints torque_Nm = gravity_Nm(plant);
      for (std::size_t i = 0; i < 3; ++i)
        torque_Nm[i] += 0.5 * std::sin(15.0 * t + 2.0 * static_cast<double>(i));
      const delta::Joints theta = plant.theta_rad();
      plant.step(dt_s, torque_Nm, {});
      for (std::size_t i = 0; i < 3; ++i)
        work_J += torque_Nm[i] * (plant.theta_rad()[i] - theta[i]);
      worst_J = std::max(worst_J, std::abs(plant.energy_J() - before_J - work_J));
    }
    return worst_J;
  };
  const double coarse_J = worst_error_J(kStep_s), fine_J = worst_error_J(0.5 * kStep_s);
  EXPECT_LT(coarse_J, 2e-3);
  EXPECT_NEAR(coarse_J / fine_J, 2.0, 0.2);  // first order, and nothing that does not vanish
}

TEST(DeltaPlant, DampersOnlyTakeEnergy) {
  for (const JointFriction& friction :
       {JointFriction{0.02, 0.0}, JointFriction{0.0, 0.01}, JointFriction{0.02, 0.01}}) {
    DeltaPlant plant(friction, kStart);
    for (int i = 0; i < 20; ++i) plant.step(kStep_s, motors_Nm(plant, {5.0, 5.0, -5.0}), {});
    double kinetic_J = 1e9;
    for (int i = 0; i < 2000; ++i) {
      plant.step(kStep_s, gravity_Nm(plant), {});
      const model::Vec3& v = plant.velocity_mps();
      const double now_J = 0.5 * dot(v, task_inertia_kg(kGeometry, kMasses, pose_of(plant)) * v);
      EXPECT_LE(now_J, kinetic_J * (1.0 + 1e-4) + 1e-18);
      kinetic_J = now_J;
    }
  }
}

TEST(DeltaPlant, ComesToRestByFriction) {
  DeltaPlant plant({.coulomb_Nm = 0.02, .viscous_Nms_per_rad = 0.002}, kStart);
  for (int i = 0; i < 200; ++i) plant.step(kStep_s, motors_Nm(plant, {2.0, -1.0, 1.0}), {});
  EXPECT_GT(norm(plant.velocity_mps()), 0.1);
  for (int i = 0; i < 8000; ++i) plant.step(kStep_s, gravity_Nm(plant), {});
  const model::Vec3 resting_m = plant.position_D_m();
  for (int i = 0; i < 4000; ++i) plant.step(kStep_s, gravity_Nm(plant), {});
  EXPECT_LT(norm(plant.position_D_m() - resting_m), 1e-9);
}

TEST(DeltaPlant, StaysPutUnderAForceBelowFriction) {
  DeltaPlant plant({.coulomb_Nm = 0.05, .viscous_Nms_per_rad = 0.0}, kStart);
  // largest singular value of J is below 0.3 here, so 0.1 N ask for less than 0.03 N m
  for (int i = 0; i < 4000; ++i) plant.step(kStep_s, motors_Nm(plant, {0.1, 0.0, 0.0}), {});
  EXPECT_LT(norm(plant.position_D_m() - kStart), 1e-6);
  // and 1 N, far above friction, moves it
  for (int i = 0; i < 400; ++i) plant.step(kStep_s, motors_Nm(plant, {1.0, 0.0, 0.0}), {});
  EXPECT_GT(norm(plant.position_D_m() - kStart), 1e-3);
}

TEST(DeltaPlant, SettlesWhereTheHandSpringBalancesTheForce) {
  const model::Vec3 force_N{1.5, -1.0, 2.0};
  const HandPull hand{.mass_kg = 0.3,
                      .stiffness_N_per_m = 400.0,
                      .damping_Ns_per_m = 12.0,
                      .aim_m = kStart,
                      .aim_velocity_mps = {}};
  DeltaPlant plant({}, kStart);
  for (int i = 0; i < 12000; ++i) plant.step(kStep_s, motors_Nm(plant, force_N), hand);
  EXPECT_LT(norm(plant.position_D_m() - (kStart + force_N / 400.0)), 1e-9);
}

TEST(DeltaPlant, AnySpringIsStable) {
  DeltaPlant plant({}, kStart);
  const HandPull vice{.mass_kg = 0.0,
                      .stiffness_N_per_m = 1e6,
                      .damping_Ns_per_m = 0.0,
                      .aim_m = kStart + model::Vec3{0.002, 0.0, 0.0},
                      .aim_velocity_mps = {}};
  for (int i = 0; i < 2000; ++i) plant.step(kStep_s, gravity_Nm(plant), vice);
  EXPECT_LT(norm(plant.position_D_m() - vice.aim_m), 1e-6);
}

TEST(DeltaPlant, CannotBePushedNearASingularPose) {
  // 20 N in every direction until it rests against stops or rim, and then falling without motors.
  for (int i = 0; i < 24; ++i) {
    const double a = 0.7 * i, z = std::cos(0.4 * i), r = std::sqrt(1.0 - z * z);
    const model::Vec3 force_N = 20.0 * model::Vec3{r * std::cos(a), r * std::sin(a), z};
    DeltaPlant plant({}, kStart);
    for (int step = 0; step < 3000; ++step) {
      plant.step(kStep_s, step < 2000 ? motors_Nm(plant, force_N) : delta::Joints{}, {});
      if (step % 20 != 0) continue;
      const auto indices = tests::delta_indices(kDelta, plant.position_D_m(), plant.theta_rad());
      ASSERT_GT(indices.least_transmission, 0.2);
      ASSERT_GT(indices.least_rod_sigma, 0.25);
      ASSERT_LT(norm(plant.velocity_mps()), 6.0);
    }
  }
}

TEST(DeltaPlant, NanStopsItInsteadOfSpreading) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  DeltaPlant plant({.coulomb_Nm = 0.01, .viscous_Nms_per_rad = 0.01}, kStart);
  plant.step(kStep_s, {nan, 0.0, 0.0}, {});
  plant.step(kStep_s, {std::numeric_limits<double>::infinity(), 0.0, 0.0}, {});
  EXPECT_EQ(plant.position_D_m(), kStart);
  EXPECT_EQ(plant.velocity_mps(), model::Vec3{});
}

TEST(DeltaPlant, LeavesTheHeapAlone) {
  DeltaPlant plant({.coulomb_Nm = 0.02, .viscous_Nms_per_rad = 0.01}, kStart);
  tests::NoAlloc guard;
  plant.step(kStep_s, {0.1, 0.2, 0.3}, {});
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::hal::sim::delta_plant_test
