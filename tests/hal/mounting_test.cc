// SPDX-License-Identifier: Apache-2.0
#include "hal/mounting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "hal/mounted_device.h"
#include "tests/support/mountings.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::mounting_test {

using tests::kMountings;
using tests::settings_of;

constexpr double kG_mps2 = 9.81;

class Puppet final : public Device {
 public:
  DeviceInfo info() const override {
    return {
        .name = "puppet",
        .max_force_N = 12.0,
        .max_continuous_force_N = 6.0,
        .workspace_radius_m = 0.18,
        .workspace_half_length_m = 0.15,
        .grip = {GripKind::kForce, 8.0},
        .turns_with_base = has_wrist,
        .at_tool = model::DeviceAtTool{
            .damping_Ns_per_m = 2.0, .friction_N = 0.3, .position_step_m = 1e-5, .delay_s = 1e-3}};
  }
  void catch_up(std::int64_t now_ns) RT_SAFE override { caught_up_ns = now_ns; }
  Fault read(Sample& out, std::int64_t) RT_SAFE override {
    if (!sample.fresh) return out.fresh = false, fault;
    out = sample;
    return fault;
  }
  Fault write(const Wrench& wrench) RT_SAFE override {
    written = wrench;
    return Fault::kNone;
  }
  void stop() override {}

  bool has_wrist = false;
  Sample sample;
  Fault fault = Fault::kNone;
  std::int64_t caught_up_ns = 0;
  Wrench written;
};

double distance(const Vec3& a, const Vec3& b) { return norm(a - b); }

TEST(Mounting, SixMountingsHaveDownWhereTheyStand) {
  for (const auto& one : kMountings) {
    const Mounting m = mounting_of(settings_of(one));
    EXPECT_LT(distance(m.gravity_in_base_mps2(), kG_mps2 * one.down_B), 1e-3) << one.words;
    EXPECT_NE(text_of(m).find(one.words), std::string::npos) << text_of(m);
  }
}

TEST(Mounting, WordsNameDownInTheBasesOwnAxesAndWhatIsScaled) {
  model::DeviceSettings settings;
  EXPECT_EQ(text_of(mounting_of(settings)),
            "the base lies on its side, its axis points towards you; down is (0, 0, -1) in its own "
            "axes");
  settings.base_orientation_deg = {0.0, 90.0, 0.0};
  settings.base_position_m = {0.0, 0.0, 0.1};
  settings.motion_scale = 3.0;
  EXPECT_EQ(text_of(mounting_of(settings)),
            "the base hangs from above, its axis points down; down is (1, 0, 0) in its own axes; "
            "its origin is at (0, 0, 0.1) m of W; the tool goes 3 times the way of the handle, and "
            "the hand gets 3 times the tool's force");
  settings.base_orientation_deg = {0.0, 45.0, 0.0};
  EXPECT_NE(text_of(mounting_of(settings))
                .find("is tilted, its axis points along (0.707, 0, "
                      "-0.707) of W"),
            std::string::npos);
}

TEST(Mounting, TheNameOfTheDeviceSaysHowItIsMountedAndScaled) {
  const auto name_of = [](const Vec3& turn_deg, double scale) {
    model::DeviceSettings settings;
    settings.base_orientation_deg = turn_deg;
    settings.motion_scale = scale;
    return mounted(Puppet().info(), mounting_of(settings)).name;
  };
  EXPECT_EQ(name_of({}, 1.0), "puppet");
  EXPECT_EQ(name_of({0, 90, 0}, 3.0), "puppet, hangs, motion x 3");
  EXPECT_EQ(name_of({0, -90, 0}, 1.0), "puppet, upright");
  EXPECT_EQ(name_of({180, 0, 0}, 1.0), "puppet, turned") << "about its own axis";
  EXPECT_EQ(name_of({0, 45, 0}, 0.5), "puppet, tilted, motion x 0.5");
}

TEST(Mounting, PowerAgreesOnBothSides) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  const auto vec = [&] { return Vec3{draw(random), draw(random), draw(random)}; };
  for (int i = 0; i < 200; ++i) {
    const Mounting m{.turn = model::quat_from_rotation_vector(3.0 * vec()),
                     .shift_m = 0.1 * vec(),
                     .scale = 0.2 + std::abs(draw(random)) * 5.0};
    const Vec3 p = vec(), v = vec(), f = vec();
    EXPECT_LT(distance(m.point_in_base(m.point_W(p)), p), 1e-12);
    EXPECT_NEAR(dot(m.force_in_base(f), v), dot(f, m.velocity_W(v)), 1e-12);
    EXPECT_NEAR(dot(m.direction_in_base(f), v), dot(f, m.direction_W(v)), 1e-12);
    const Vec3 way = (m.point_W(p + 1e-6 * v) - m.point_W(p)) / 1e-6;
    EXPECT_LT(distance(way, m.velocity_W(v)), 1e-8);
  }
}

TEST(Mounting, TheWorkspaceIsReachedFromEveryMounting) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  const DeviceInfo own = Puppet().info();
  for (int i = 0; i < 300; ++i) {
    const Mounting m{.turn = model::quat_from_rotation_vector(
                         3.0 * Vec3{draw(random), draw(random), draw(random)}),
                     .shift_m = 0.02 * Vec3{draw(random), draw(random), draw(random)},
                     .scale = 1.0 + draw(random) * 0.5};
    const DeviceInfo info = mounted(own, m);
    ASSERT_GT(info.workspace_radius_m, 0.0);
    for (int k = 0; k < 40; ++k) {
      const double angle = 0.05 * std::numbers::pi * k;
      const Vec3 stop_W{k % 2 == 0 ? info.workspace_half_length_m : -info.workspace_half_length_m,
                        info.workspace_radius_m * std::cos(angle),
                        info.workspace_radius_m * std::sin(angle)};
      const Vec3 p = m.point_in_base(stop_W);
      ASSERT_LE(std::hypot(p.y, p.z), own.workspace_radius_m * (1.0 + 1e-9)) << i;
      ASSERT_LE(std::abs(p.x), own.workspace_half_length_m * (1.0 + 1e-9)) << i;
    }
  }
}

TEST(Mounting, ADeviceThatOnlyRollsAboutItsAxisKeepsItsWorkspace) {
  const Mounting m{.turn = model::quat_from_rotation_vector({1.2, 0.0, 0.0}), .shift_m = {}};
  const DeviceInfo info = mounted(Puppet().info(), m);
  EXPECT_NEAR(info.workspace_radius_m, 0.18, 1e-12);
  EXPECT_NEAR(info.workspace_half_length_m, 0.15, 1e-12);
}

TEST(Mounting, AScaleIsInWhatBoundsTheStiffness) {
  const DeviceInfo info = mounted(Puppet().info(), {.turn = {}, .shift_m = {}, .scale = 3.0});
  EXPECT_DOUBLE_EQ(info.max_force_N, 4.0) << "12 N at the handle";
  EXPECT_DOUBLE_EQ(info.max_continuous_force_N, 2.0);
  EXPECT_DOUBLE_EQ(info.workspace_radius_m, 0.54);
  EXPECT_DOUBLE_EQ(info.motion_scale, 3.0);
  ASSERT_TRUE(info.at_tool);
  // The same power: F_B v_B = (3 F_W) (v_W / 3), and F_B = b v_B is F_W = b / 9 v_W.
  EXPECT_DOUBLE_EQ(info.at_tool->damping_Ns_per_m, 2.0 / 9.0);
  EXPECT_DOUBLE_EQ(info.at_tool->friction_N, 0.1);
  EXPECT_DOUBLE_EQ(info.at_tool->position_step_m, 3e-5);
  EXPECT_DOUBLE_EQ(info.at_tool->delay_s, 1e-3);
}

class Mounted : public testing::Test {
 protected:
  explicit Mounted() { inner_.release(); }

  // Hangs from above, 0.1 m up, twice the way.
  Mounting mounting_{.turn = model::quat_from_rotation_vector({0.0, std::numbers::pi / 2, 0.0}),
                     .shift_m = {0.0, 0.0, 0.1},
                     .scale = 2.0};
  std::unique_ptr<Puppet> inner_ = std::make_unique<Puppet>();
  Puppet& puppet_ = *inner_;
  MountedDevice device_{std::unique_ptr<Device>(&puppet_), mounting_};
};

TEST_F(Mounted, PoseAndVelocityAreThoseOfTheRoom) {
  puppet_.sample.fresh = true;
  puppet_.sample.sequence = 7;
  puppet_.sample.grip_gap_m = 0.01;
  puppet_.sample.tool.position_m = {0.03, 0.01, 0.02};  // 30 mm along its axis, which points down
  puppet_.sample.tool.velocity_mps = {0.1, 0.0, 0.0};
  puppet_.sample.tool.grip_ratio = 0.5;
  Sample sample;
  const tests::NoAlloc guard;
  EXPECT_EQ(device_.read(sample, 1), Fault::kNone);
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_TRUE(sample.fresh);
  EXPECT_EQ(sample.sequence, 7u);
  EXPECT_EQ(sample.tool.grip_ratio, 0.5);
  EXPECT_EQ(sample.grip_gap_m, 0.01);
  EXPECT_LT(distance(sample.tool.position_m, {0.04, 0.02, 0.1 - 0.06}), 1e-12);
  EXPECT_LT(distance(sample.tool.velocity_mps, {0.0, 0.0, -0.2}), 1e-12);
}

TEST_F(Mounted, CatchesUpBeforeTheLoop) {
  device_.catch_up(7);
  EXPECT_EQ(puppet_.caught_up_ns, 7);
}

TEST_F(Mounted, AForceUpIsAForceAgainstItsAxis) {
  EXPECT_EQ(device_.write({.force_N = {0.0, 0.0, 1.5}, .torque_Nm = {}}), Fault::kNone);
  EXPECT_LT(distance(puppet_.written.force_N, {-3.0, 0.0, 0.0}), 1e-12);
}

TEST_F(Mounted, WithoutASampleTheOldOneStaysAndTheFaultIsHandedOn) {
  Sample sample;
  sample.tool.position_m = {1.0, 2.0, 3.0};
  sample.fresh = true;
  puppet_.fault = Fault::kDeviceFailed;
  EXPECT_EQ(device_.read(sample, 1), Fault::kDeviceFailed);
  EXPECT_FALSE(sample.fresh);
  EXPECT_EQ(sample.tool.position_m, (Vec3{1.0, 2.0, 3.0}));
}

TEST_F(Mounted, AHandleWithoutAWristStaysAsTheSceneDrawsIt) {
  puppet_.sample.fresh = true;
  Sample sample;
  EXPECT_EQ(device_.read(sample, 1), Fault::kNone);
  EXPECT_EQ(sample.tool.orientation, model::Quat{});
}

TEST(MountedWrist, TurnsWithItsBaseAndSoDoesTheTorque) {
  auto owned = std::make_unique<Puppet>();
  Puppet& puppet = *owned;
  puppet.has_wrist = true;
  puppet.sample.fresh = true;
  puppet.sample.tool.angular_velocity_radps = {1.0, 0.0, 0.0};
  MountedDevice device(std::move(owned),
                       {.turn = model::quat_from_rotation_vector({0.0, std::numbers::pi / 2, 0.0}),
                        .shift_m = {},
                        .scale = 2.0});
  Sample sample;
  EXPECT_EQ(device.read(sample, 1), Fault::kNone);
  EXPECT_LT(distance(rotate(sample.tool.orientation, {1, 0, 0}), {0, 0, -1}), 1e-12);
  EXPECT_LT(distance(sample.tool.angular_velocity_radps, {0, 0, -1}), 1e-12);
  EXPECT_EQ(device.write({.force_N = {}, .torque_Nm = {0.0, 0.0, 0.1}}), Fault::kNone);
  EXPECT_LT(distance(puppet.written.torque_Nm, {-0.1, 0.0, 0.0}), 1e-12) << "turns are not scaled";
}

}  // namespace tact::hal::mounting_test
