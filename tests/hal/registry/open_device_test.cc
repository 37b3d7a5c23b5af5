// SPDX-License-Identifier: Apache-2.0
#include "hal/registry/open_device.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "hal/sim/sim_delta.h"
#include "model/law/haptic_limit.h"

namespace tact::hal::registry::open_device_test {

model::scene::Scene scene(const char* kind) {
  model::scene::Scene scene;
  scene.path = "liver.toml";
  scene.device.kind = kind;
  scene.device.of<sim::SimDeviceSettings>() = {.counts_per_turn = 100'000.0,
                                               .sample_delay_s = 0.3e-3,
                                               .joint_friction_Nm = 0.01,
                                               .joint_damping_Nms_per_rad = 0.002,
                                               .observer_bandwidth_Hz = 40.0};
  scene.hand.path = {{}};
  return scene;
}

class RealDevice final : public Device {
 public:
  DeviceInfo info() const override { return {.name = "a real one", .grip = GripKind::kNone}; }
  Fault read(Sample&, std::int64_t) RT_SAFE override { return Fault::kNone; }
  Fault write(const Wrench&) RT_SAFE override { return Fault::kNone; }
  void stop() override {
    if (stops != nullptr) ++*stops;
  }
  int* stops = nullptr;
};

TEST(OpenDevice, OpensTheSimulatedDelta) {
  const auto device = open_device(scene("sim-delta"));
  ASSERT_TRUE(device) << device.error().message;
  EXPECT_EQ((*device)->info().name, "simulated delta 360 x 300 mm");
  EXPECT_TRUE(is_simulated(**device));
}

TEST(OpenDevice, IdealDeviceIsNamedAndBears40kNPerMetre) {
  model::scene::Scene ideal = scene("sim-ideal");
  ideal.hand.damping_Ns_per_m = 15.0;
  const auto device = open_device(ideal);
  ASSERT_TRUE(device) << device.error().message;
  EXPECT_TRUE(is_simulated(**device));
  EXPECT_TRUE((*device)->info().name.starts_with("IDEAL simulated delta"));
  const auto at_tool = (*device)->info().at_tool;
  EXPECT_GT(model::law::haptic_limit(*at_tool, 1000.0).grow_N_per_m, 40e3);
}

TEST(OpenDevice, ABaseThatHangsIsTurnedBetweenLoopAndDevice) {
  model::scene::Scene hanging = scene("sim-delta");
  hanging.device.base_orientation_deg = {0.0, 90.0, 0.0};
  hanging.hand.path = {{.position_m = {0.0, 0.0, 0.05}}};
  const auto device = open_device(hanging);
  ASSERT_TRUE(device) << device.error().message;
  EXPECT_EQ((*device)->info().name, "simulated delta 360 x 300 mm, hangs") << "as the page reports";
  EXPECT_LT((*device)->info().workspace_radius_m, 0.15);
  EXPECT_TRUE(is_simulated(**device)) << "its hand can be moved";
  Sample sample;
  for (int i = 0; i < 3; ++i) (*device)->between_ticks(1e-3);
  EXPECT_EQ((*device)->read(sample, 3'000'000), Fault::kNone);
  EXPECT_NEAR(sample.tool.position_m.z, 0.05, 1e-3);
  EXPECT_TRUE(start_hand_socket(
      **device, testing::TempDir() + "tact-hang-" + std::to_string(getpid()) + ".sock"));
}

TEST(OpenDevice, IsStoppedAtEveryEndOfItsHolder) {
  int stops = 0;
  {
    auto* real = new RealDevice;
    real->stops = &stops;
    const tact::hal::registry::OpenDevice device(real);
  }
  EXPECT_EQ(stops, 1);
}

TEST(OpenDevice, AnUnknownKindListsTheKnownOnes) {
  const auto device = open_device(scene("sim-dleta"));
  ASSERT_FALSE(device);
  const std::string& said = device.error().message;
  EXPECT_TRUE(said.starts_with(
      "liver.toml: device.kind is \"sim-dleta\", which this build does not know; use "
      "\"sim-delta\", "))
      << said;
  for (const char* known : {", \"can-odrive\"", ", \"force-dimension\"", ", \"phantom\""})
    EXPECT_NE(said.find(known), std::string::npos) << known << " in " << said;
}

TEST(OpenDevice, PassesOnWhatTheDeviceRefuses) {
  model::scene::Scene bad = scene("sim-delta");
  bad.device.of<sim::SimDeviceSettings>().counts_per_turn = -1.0;
  const auto device = open_device(bad);
  ASSERT_FALSE(device);
  EXPECT_NE(device.error().message.find("liver.toml"), std::string::npos);
  EXPECT_NE(device.error().message.find("counts_per_turn"), std::string::npos);
}

TEST(OpenDevice, OnlyASimulatedHandCanBeMoved) {
  const std::string path = testing::TempDir() + "tact-open-" + std::to_string(getpid()) + ".sock";
  const auto device = open_device(scene("sim-delta"));
  ASSERT_TRUE(device);
  EXPECT_TRUE(start_hand_socket(**device, path));
  RealDevice real;
  EXPECT_FALSE(is_simulated(real));
  EXPECT_FALSE(start_hand_socket(real, path));
}

}  // namespace tact::hal::registry::open_device_test
