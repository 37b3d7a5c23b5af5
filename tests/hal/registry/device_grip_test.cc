// SPDX-License-Identifier: Apache-2.0
// How the hand closes the jaws on each device of the registry.
#include <gtest/gtest.h>

#include <map>
#include <type_traits>

#include "hal/falcon/falcon_device.h"
#include "hal/odrive/odrive_delta.h"
#include "hal/registry/open_device.h"
#include "hal/sim/sim_delta.h"
#include "tests/hal/emulated/cia402_emulated_bench.h"
#include "tests/hal/moteus/moteus_bench.h"
#include "tests/rig/emulators/odrive/odrive_drive.h"
#include "tests/support/stub_dhd/stub_client.h"
#include "tests/support/stub_hd/hd_client.h"

namespace tact::hal::registry::device_grip_test {

// A back end that says nothing of its grip does not compile.
static_assert(!std::is_default_constructible_v<DeviceGrip>);
static_assert(!std::is_default_constructible_v<DeviceInfo>);

struct SilentPipe final : falcon::FalconPipe {
  bool submit(const falcon::FalconPacket&) RT_SAFE override { return true; }
  bool newest(falcon::FalconReply&) RT_SAFE override { return false; }
  falcon::FalconPipeHealth health() const RT_SAFE override { return {}; }
  void stop(const falcon::FalconPacket&) override {}
};

GripKind grip_of_opened(const model::scene::Scene& scene) {
  const auto device = open_device(scene);
  EXPECT_TRUE(device) << device.error().message;
  return device ? (*device)->info().grip.kind : GripKind::kNone;
}

template <class Bench>
GripKind grip_of_bench(Bench&& bench) {
  EXPECT_EQ(bench.open(), "");
  return bench.device ? bench.device->info().grip.kind : GripKind::kForce;
}

struct OdriveDrives : tests::EmulatedDrives {
  OdriveDrives() : EmulatedDrives(32) {}
};
struct OdriveBench : tests::CanBench<OdriveDrives> {
  OdriveBench() : CanBench(tests::jig_settings(tests::published_pose())) {
    drives.install<rig::OdriveDrive>(rig::OdriveSettings{});
  }
  std::string open() { return CanBench::open(&odrive::start_odrive_delta); }
};

std::map<std::string, GripKind> grip_of_each_kind() {
  model::scene::Scene simulated;
  simulated.device.kind = "sim-delta";
  simulated.device.of<sim::SimDeviceSettings>() = {.counts_per_turn = 100'000.0,
                                                   .observer_bandwidth_Hz = 40.0};
  simulated.hand.path = {{}};
  model::scene::Scene ideal = simulated;
  ideal.device.kind = "sim-ideal";
  const tests::StubDhd dhd;
  const tests::StubHd hd;
  return {
      {"sim-delta", grip_of_opened(simulated)},
      {"sim-ideal", grip_of_opened(ideal)},
      {"can-odrive", grip_of_bench(OdriveBench())},
      {"can-cia402", grip_of_bench(emulated::Cia402Bench())},
      {"can-moteus", grip_of_bench(tests::MoteusBench())},
      {"falcon", falcon::FalconDevice({}, std::make_unique<SilentPipe>()).info().grip.kind},
      {"force-dimension", grip_of_opened(tests::stub_scene())},
      {"phantom", grip_of_opened(tests::phantom_scene())},
  };
}

TEST(DeviceGrip, EveryBackEndOfTheRegistrySaysHowItGrips) {
  const std::map<std::string, GripKind> expected{
      {"sim-delta", GripKind::kForce},        {"sim-ideal", GripKind::kForce},
      {"can-odrive", GripKind::kNone},        {"can-cia402", GripKind::kNone},
      {"can-moteus", GripKind::kNone},        {"falcon", GripKind::kButton},
      {"force-dimension", GripKind::kButton}, {"phantom", GripKind::kButton}};
  const auto reported = grip_of_each_kind();
  for (const std::string& kind : device_kinds()) {
    model::scene::Scene by_name;
    by_name.device.kind = kind;
    // Only a device without settings opens by its name alone: any other has a row here.
    if (!reported.contains(kind))
      grip_of_opened(by_name);
    else
      EXPECT_EQ(reported.at(kind), expected.at(kind)) << kind;
  }
}

}  // namespace tact::hal::registry::device_grip_test
