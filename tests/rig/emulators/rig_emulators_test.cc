// SPDX-License-Identifier: Apache-2.0
// The devices of the virtual bench, without a kernel under them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/rig/emulators/falcon/ftdi_chip.h"
#include "tests/rig/emulators/mechanics/delta_mechanism.h"
#include "tests/rig/emulators/mechanics/falcon_mechanism.h"
#include "tests/rig/emulators/mechanics/platform.h"
#include "tests/rig/emulators/self_check/self_check.h"

namespace tact::rig::rig_emulators_test {

constexpr std::int64_t kMs = 1'000'000, kStart = 1'000 * kMs;
constexpr const char* kVectors = TACT_SOURCE_DIR "/tests/data/vectors";

FaultPlan ordered(const std::string& text) {
  Fault fault;
  std::string error;
  EXPECT_TRUE(parse_fault(text, FaultSide::kDrives, fault, error)) << error;
  FaultPlan plan({fault});
  plan.start(kStart);
  return plan;
}

TEST(RigEmulators, EmulatorCodecAndKinematicsMatchThePublishedVectors) {
  EXPECT_EQ(check_drives(kVectors), 0);
  EXPECT_EQ(check_falcon(kVectors), 0);
}

TEST(RigEmulators, AVectorThatDiffersIsSeen) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("rig_emulators_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  for (const std::string name : {"can_odrive.json", "can_cia402.json", "kinematics_delta.json"}) {
    for (const auto& entry : std::filesystem::directory_iterator(kVectors))
      std::filesystem::copy(entry, folder, std::filesystem::copy_options::overwrite_existing);
    ASSERT_EQ(check_drives(folder), 0);
    std::stringstream text;
    text << std::ifstream(folder / name).rdbuf();
    std::string spoiled = text.str();
    // One digit of a datum in the middle.
    const std::string key = name.starts_with("can") ? "\"data\": \"" : "\"theta\":";
    std::size_t at = spoiled.find(key, spoiled.size() / 2) + key.size();
    at = name.starts_with("can") ? at + 3 : spoiled.find('.', at) + 2;
    ASSERT_LT(at, spoiled.size());
    spoiled[at] = spoiled[at] == '7' ? '6' : '7';
    std::ofstream(folder / name) << spoiled;
    EXPECT_EQ(check_drives(folder), 1) << name;
  }
  std::filesystem::remove_all(folder);
  EXPECT_EQ(check_drives(folder), 2);  // none there
}

TEST(RigEmulators, GravityIsCarriedByTheHandWhenTheMotorsAreOff) {
  const DeltaMechanism delta;
  Platform platform(delta, {}, kStart);
  for (int ms = 1; ms <= 2000; ++ms) platform.advance(kStart + ms * kMs, {});
  const Vec3 pulled = 600.0 * (Vec3{0.0, 0.0, 0.060} - platform.position_m());
  EXPECT_LT(model::norm(pulled + platform.pose().weight_N), 0.02);
  EXPECT_LT(platform.pose().weight_N.z, -3.0);  // at least platform and rods
}

TEST(RigEmulators, TorquesThatCarryGravityLeaveTheHandWithoutForce) {
  const DeltaMechanism delta;
  Platform platform(delta, {}, kStart);
  for (int ms = 1; ms <= 2000; ++ms) {
    const Joints tau = torque_of(platform.pose(), -platform.pose().weight_N);
    EXPECT_LT(model::norm(platform.hand_force_N(tau)), 1e-9);
    platform.advance(kStart + ms * kMs, tau);
  }
  EXPECT_LT(model::norm(platform.position_m() - Vec3{0.0, 0.0, 0.060}), 1e-4);
}

TEST(RigEmulators, AnEmulatorThatWasStoppedDoesNotExplode) {
  const DeltaMechanism delta;
  Platform platform(delta, {}, kStart);
  platform.release(kStart);
  platform.advance(kStart + 1000 * kMs, {});
  platform.advance(kStart + 4'000 * kMs, {3.0, -3.0, 3.0});
  platform.advance(kStart + 4'001 * kMs, {});
  EXPECT_TRUE(model::is_finite(platform.position_m()));
  EXPECT_LT(platform.travel_m(), 0.05);
}

TEST(RigEmulators, TheHandGoesWhereItsPathSaysWithoutJumps) {
  const Hand hand;
  HandTarget before = hand_target(hand, 0.0);
  EXPECT_EQ(before.position_m, (Vec3{0.0, 0.0, 0.060}));
  double lowest = 1.0;
  for (int ms = 1; ms <= 12'000; ++ms) {
    const HandTarget at = hand_target(hand, 1e-3 * ms);
    const Vec3 mean = 0.5 * (at.velocity_mps + before.velocity_mps);
    EXPECT_LT(model::norm(at.position_m - before.position_m - 1e-3 * mean), 1e-7) << ms;
    lowest = std::min(lowest, at.position_m.z);
    before = at;
  }
  EXPECT_NEAR(lowest, -0.010, 1e-12);
  EXPECT_NEAR(hand_target(hand, 3.5).position_m.y, 0.020, 1e-12);
}

TEST(RigEmulators, TheFalconReachesTheWholePathOfItsHand) {
  const FalconMechanism falcon(0.110, 0.0);
  const Hand hand{.top_m = 0.030};
  for (int ms = 0; ms < 6000; ms += 10) {
    const Vec3 at = hand_target(hand, 1e-3 * ms).position_m;
    for (const double pull : {-0.015, 0.0, 0.020})
      EXPECT_TRUE(falcon.pose(at + Vec3{pull, 0.0, 0.0})) << ms;
  }
}

TEST(RigEmulators, AFaultReportsWhatTheOtherSideDid) {
  FaultPlan plan = ordered("silent@0");
  plan.tick(kStart);
  plan.watch(1.0, false, kStart + kMs);
  plan.watch(0.3, false, kStart + 2 * kMs);
  plan.watch(0.0, true, kStart + 3 * kMs);
  const Fault& fault = plan.faults()[0];
  EXPECT_EQ(fault.last_force_ns, kStart + 2 * kMs);
  EXPECT_EQ(fault.torque_zero_ns, kStart + 3 * kMs);
  EXPECT_EQ(fault.largest_after_zero_N, 0.0);
  plan.watch(0.7, false, kStart + 9 * kMs);  // it moved again
  EXPECT_EQ(fault.largest_after_zero_N, 0.7);
}

TEST(RigEmulators, AnOrderThatIsNoFaultIsRefusedWithTheRemedy) {
  Fault fault;
  std::string error;
  for (const char* const text : {"", "lost", "lost@", "lost@x", "lost:4@1", "lost@1+", "lost@1+-5",
                                 "stall@1", "lost@nan", "lost:@1", "lost:@1x", "@1"}) {
    EXPECT_FALSE(parse_fault(text, FaultSide::kDrives, fault, error)) << text;
    EXPECT_NE(error, "") << text;
  }
  EXPECT_TRUE(parse_fault("no-reply:3@1.5", FaultSide::kFalcon, fault, error));
  EXPECT_EQ(fault.duration_ns, 3 * kMs);
  EXPECT_EQ(fault.at_ns, 1500 * kMs);
}

TEST(RigEmulators, TheEventCharacterBringsAReportBeforeTheLatencyTimer) {
  for (const bool event : {true, false}) {
    FaultPlan faults;
    FalconFirmware firmware({.runs_already = true}, faults);
    FtdiChip chip(firmware, false);
    std::int64_t now = kStart;
    ASSERT_TRUE(chip.control({0x40, 3, 2, 0, 0}, now));  // 1.5 Mbaud
    ASSERT_TRUE(chip.control({0x40, 9, 1, 0, 0}, now));  // 1 ms
    const std::uint16_t on = event ? 0x100 : 0;
    ASSERT_TRUE(chip.control({0x40, 6, static_cast<std::uint16_t>(on | 0x3E), 0, 0}, now));
    chip.packet(now);  // the timer starts again
    chip.write(bytes_of_hex("3c41414141414141414141414142413e"), now);
    std::int64_t arrived = 0;
    while (arrived == 0) {
      now += 10'000;
      chip.advance(now);
      const auto packet = chip.packet(now);
      if (!packet) continue;
      arrived = now;
      EXPECT_EQ(packet->size(), 18u);
    }
    // 32 bytes of 10 bits at 1.5 Mbaud are 213 us; looked at every 10 us.
    const double wait_us = 1e-3 * static_cast<double>(arrived - kStart);
    EXPECT_GE(wait_us, event ? 213.0 : 1000.0);
    EXPECT_LE(wait_us, event ? 224.0 : 1000.0);
  }
}

TEST(RigEmulators, CountsJumpWhenTheFalconFindsItsHome) {
  FaultPlan faults;
  FalconFirmware firmware({.runs_already = true, .homing_ms = 100}, faults);
  firmware.set_joints({kFalconZero_rad, kFalconZero_rad, kFalconZero_rad});
  const auto ask = [&](std::int64_t now) {
    FalconScanner scanner(0xC0);
    std::optional<FalconFrame> report;
    for (const std::uint8_t byte : bytes_of_hex("3c41414141414141414141414142413e")) {
      firmware.receive(byte, 1.5e6, now, [&](std::uint8_t out) {
        if (const auto frame = scanner.push(out)) report = frame;
      });
    }
    EXPECT_TRUE(report);
    return report ? decode_report(*report) : FalconReport{};
  };
  EXPECT_EQ(ask(kStart).homed, 0);
  EXPECT_NE(ask(kStart).counts, (std::array<int, 3>{}));
  const FalconReport home = ask(kStart + 100 * kMs);
  EXPECT_EQ(home.homed, 7);
  EXPECT_EQ(home.counts, (std::array<int, 3>{}));
}

}  // namespace tact::rig::rig_emulators_test
