// SPDX-License-Identifier: Apache-2.0
// The emulated drives of the virtual bench: states, watchdogs, and what is done to their frames.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>

#include "tests/rig/emulators/cia402/cia402_drive.h"
#include "tests/rig/emulators/moteus/moteus_drive.h"
#include "tests/rig/emulators/odrive/odrive_drive.h"
#include "tests/rig/emulators/self_check/self_check.h"

namespace tact::rig::rig_drives_test {

constexpr std::int64_t kMs = 1'000'000, kStart = 1'000 * kMs;

canfd_frame frame_of(std::uint32_t id, std::vector<std::uint8_t> data) {
  canfd_frame frame{};
  frame.can_id = id;
  frame.len = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), std::begin(frame.data));
  return frame;
}
std::vector<std::uint8_t> float_bytes(float value) {
  std::vector<std::uint8_t> bytes(4);
  std::memcpy(bytes.data(), &value, 4);
  return bytes;
}
FaultPlan ordered(const std::string& text) {
  Fault fault;
  std::string error;
  EXPECT_TRUE(parse_fault(text, FaultSide::kDrives, fault, error)) << error;
  FaultPlan plan({fault});
  plan.start(kStart);
  return plan;
}

/// The cable as a pair of sockets; what the drives said lies on the other end.
struct Cable {
  explicit Cable(FaultPlan& faults, std::uint32_t node_step) : bus(faults, node_step) {
    int ends[2];
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends), 0);
    bus.adopt(ends[0]);
    host = ends[1];
  }
  Cable(const Cable&) = delete;
  Cable& operator=(const Cable&) = delete;
  ~Cable() { close(host); }
  std::vector<can_frame> heard() const {
    std::vector<can_frame> frames;
    for (can_frame frame{}; read(host, &frame, sizeof frame) == sizeof frame;)
      frames.push_back(frame);
    return frames;
  }
  CanBus bus;
  int host = -1;
};

struct OdriveBench {
  explicit OdriveBench(OdriveGeneration generation, const std::string& fault = "lost@1000")
      : faults(ordered(fault)),
        cable(faults, 32),
        drive(0, 1, {.generation = generation}, cable.bus, motor, faults) {}
  void report(std::uint8_t command, std::vector<std::uint8_t> data) {
    drive.receive(frame_of(1u << 5u | command, std::move(data)), now);
  }
  void enable() {
    report(0x0B, {1, 0, 0, 0, 1, 0, 0, 0});
    report(0x07, {8, 0, 0, 0, 0, 0, 0, 0});
  }
  void wait(int ms) {
    for (int i = 0; i < ms; ++i) {
      now += kMs;
      faults.tick(now);
      drive.tick(now);
    }
  }
  FaultPlan faults;
  Motor motor{};
  Cable cable;
  OdriveDrive drive;
  std::int64_t now = kStart;
};

TEST(RigDrives, AnOdriveThatHearsNothingStopsByItsOwnWatchdog) {
  for (const auto generation : {OdriveGeneration::k05, OdriveGeneration::k06}) {
    OdriveBench bench(generation);
    bench.enable();
    bench.report(0x0E, float_bytes(0.5F));
    bench.wait(10);
    EXPECT_DOUBLE_EQ(bench.drive.torque_Nm(), 0.5);
    bench.wait(1);
    EXPECT_EQ(bench.drive.torque_Nm(), 0.0);
    EXPECT_TRUE(bench.drive.tripped());
    bench.report(0x0E, float_bytes(0.5F));
    bench.enable();
    EXPECT_FALSE(bench.drive.is_enabled());  // latched
    bench.report(0x18, {0});
    bench.enable();
    EXPECT_TRUE(bench.drive.is_enabled());
    EXPECT_DOUBLE_EQ(bench.drive.torque_Nm(), 0.5);  // as last commanded
  }
}

TEST(RigDrives, OnlyAnIdleOdriveOf05IsWatched) {
  for (const bool is_05 : {true, false}) {
    OdriveBench bench(is_05 ? OdriveGeneration::k05 : OdriveGeneration::k06);
    bench.wait(30);
    bench.enable();
    EXPECT_EQ(bench.drive.is_enabled(), !is_05);
    bench.report(0x18, {0});
    bench.enable();
    EXPECT_TRUE(bench.drive.is_enabled());
    EXPECT_FALSE(bench.drive.tripped()) << "no torque was taken";
  }
}

TEST(RigDrives, OnlyAnOdriveOf05IsFedByAnyFrame) {
  for (const bool is_05 : {true, false}) {
    OdriveBench bench(is_05 ? OdriveGeneration::k05 : OdriveGeneration::k06);
    bench.enable();
    for (int i = 0; i < 4; ++i) {
      bench.wait(5);
      bench.report(0x17, {});
    }
    EXPECT_EQ(bench.drive.is_enabled(), is_05);
  }
}

TEST(RigDrives, ACia402DriveStopsWhenTheHostsHeartbeatIsLost) {
  FaultPlan faults = ordered("lost@1000");
  Cable cable(faults, 1);
  const Motor motor{.position_turns = 0.25};
  Cia402Drive drive(0, 5, {}, cable.bus, motor, faults);
  std::int64_t now = kStart;
  const auto wait = [&](int ms) {
    for (int i = 0; i < ms; ++i) drive.tick(now += kMs);
  };
  const auto report = [&](std::uint32_t id, std::vector<std::uint8_t> data) {
    return drive.receive(frame_of(id, std::move(data)), now);
  };
  wait(25);
  auto frames = cable.heard();
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].can_id, 0x705u);  // boot-up
  const auto vectors = SelfCheck(TACT_SOURCE_DIR "/tests/data/vectors").load("can_cia402.json");
  for (const auto& item : vectors["config_sequence_node5"])
    report(0x605, bytes_of_hex(item["frame"]));
  report(0x000, {1, 5});
  for (const std::uint8_t word : std::initializer_list<std::uint8_t>{0x06, 0x07, 0x0F}) {
    report(0x77F, {5});
    for (int time = 0; time < 2; ++time) {  // type 1: they act at the next SYNC
      EXPECT_TRUE(report(0x205, {word, 0, 100, 0}));
      EXPECT_FALSE(report(0x080, {}));
      wait(7);
    }
  }
  ASSERT_TRUE(drive.is_enabled());
  EXPECT_NEAR(drive.torque_Nm(), 0.032, 1e-12);  // 100 of 1000 of 0.32 N m
  cable.heard();
  report(0x080, {});
  frames = cable.heard();
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].can_id, 0x185u);
  EXPECT_EQ(get_raw({&frames[0].data[2], 4}), 2500u);
  wait(11);
  EXPECT_EQ(drive.torque_Nm(), 0.0);
  EXPECT_TRUE(drive.tripped());
  bool said = false;
  for (const can_frame& frame : cable.heard())
    said |= frame.can_id == 0x085u && get_raw({&frame.data[0], 2}) == 0x8130;
  EXPECT_TRUE(said);
}

TEST(RigDrives, ACia402DriveAnswersItsGuardAndMissesItAfterTheFirstRequest) {
  for (const bool from_boot : {false, true}) {
    FaultPlan faults = ordered("lost@1000");
    Cable cable(faults, 1);
    const Motor motor{};
    const ObjectHabits habits{
        .guard_time_ms = 10, .life_time_factor = 3, .life_from_boot = from_boot};
    Cia402Drive drive(0, 5, {.habits = habits}, cable.bus, motor, faults);
    std::int64_t now = kStart;
    const auto wait = [&](int ms) {
      for (int i = 0; i < ms; ++i) drive.tick(now += kMs);
    };
    const auto guard = [&] { drive.receive(frame_of(CAN_RTR_FLAG | 0x705, {}), now); };
    const std::vector<std::uint16_t> missed = {0x8130};
    wait(100);
    EXPECT_EQ(drive.noted().empty(), !from_boot);
    if (from_boot) continue;
    cable.heard();
    std::vector<std::uint8_t> states;
    for (int i = 0; i < 3; ++i) {
      guard();
      wait(30);
    }
    EXPECT_TRUE(drive.noted().empty());
    for (const can_frame& frame : cable.heard()) states.push_back(frame.data[0]);
    EXPECT_EQ(states, (std::vector<std::uint8_t>{0x7F, 0xFF, 0x7F}));
    wait(1);
    EXPECT_EQ(drive.noted(), missed);
    wait(100);
    EXPECT_EQ(drive.noted(), missed) << "once";
    guard();
    drive.receive(frame_of(0x605, {0x2B, 0x0C, 0x10, 0, 0, 0, 0, 0}), now);  // 100C = 0
    wait(100);
    EXPECT_EQ(drive.noted(), missed) << "switched off";
  }
}

TEST(RigDrives, AMoteusHoldsPositionUnlessBothGainsAreZero) {
  FaultPlan faults = ordered("lost@1000");
  Cable cable(faults, 0x100);
  const Motor motor{.position_turns = 0.25};
  MoteusDrive drive(0, 1, {.prepare_ms = 2}, cable.bus, motor, faults);
  std::int64_t now = kStart;
  const auto wait = [&](int ms) {
    for (int i = 0; i < ms; ++i) drive.tick(now += kMs);
  };
  const auto report = [&](std::vector<std::uint8_t> data) {
    return drive.receive(frame_of(0x8001 | CAN_EFF_FLAG, std::move(data)), now);
  };
  EXPECT_TRUE(report({0x01, 0x00, 0x0A}));
  wait(2);
  ASSERT_TRUE(drive.is_enabled());
  EXPECT_DOUBLE_EQ(drive.torque_Nm(), -1.0);  // 4 N m/turn towards position 0
  // Both scales as int8 0, then 0.5 N m as int16, then 10 ms as int8.
  EXPECT_TRUE(report({0x01, 0x00, 0x0A, 0x02, 0x23, 0, 0, 0x05, 0x22, 50, 0, 0x01, 0x27, 1}));
  EXPECT_DOUBLE_EQ(drive.torque_Nm(), 0.5);
  wait(11);
  EXPECT_FALSE(drive.is_enabled());
  EXPECT_TRUE(drive.tripped());
  report({0x01, 0x00, 0x0A});
  wait(5);
  EXPECT_EQ(drive.mode(), 11) << "a stop alone leads out";
  EXPECT_FALSE(report({0x01, 0x00, 0x00}));
  EXPECT_EQ(drive.mode(), 0);
}

TEST(RigDrives, EveryFaultOfTheCableIsCommitted) {
  struct Row {
    std::string fault;
    std::vector<std::uint32_t> ids;  // of the estimates of four milliseconds
  };
  const Row rows[] = {{"lost@0+2", {0x29, 0x29}},
                      {"duplicated@0+2", {0x29, 0x29, 0x29, 0x29, 0x29, 0x29}},
                      {"reordered@0+3", {0x29, 0x29, 0x29, 0x29}},
                      {"wrong-node@0+1", {0x229, 0x29, 0x29, 0x29}},
                      {"silent@0+3", {0x29}},
                      {"lost:2@0+2", {0x29, 0x29, 0x29, 0x29}}};
  for (const Row& row : rows) {
    OdriveBench bench(OdriveGeneration::k06, row.fault);
    std::vector<std::uint32_t> ids;
    std::vector<double> positions;
    for (int i = 0; i < 4; ++i) {
      bench.motor.position_turns = 0.1 * (i + 1);
      bench.wait(1);
    }
    for (const can_frame& frame : bench.cable.heard()) {
      if ((frame.can_id & 31u) != 9) continue;
      ids.push_back(frame.can_id);
      positions.push_back(get_field(frame.data, {"", 0, WireType::kF32}));
    }
    EXPECT_EQ(ids, row.ids) << row.fault;
    if (!row.fault.starts_with("reordered")) continue;
    ASSERT_EQ(positions.size(), 4u);
    EXPECT_GT(positions[0], positions[1]);  // the newer first
  }
}

TEST(RigDrives, AStaleSampleStaysAsItWas) {
  OdriveBench bench(OdriveGeneration::k06, "stale@0.002+2");
  std::vector<double> positions;
  for (int i = 1; i <= 5; ++i) {
    bench.motor.position_turns = 0.1 * i;
    bench.wait(1);
  }
  for (const can_frame& frame : bench.cable.heard())
    if ((frame.can_id & 31u) == 9)
      positions.push_back(get_field(frame.data, {"", 0, WireType::kF32}));
  ASSERT_EQ(positions.size(), 5u);
  EXPECT_NEAR(positions[0], 0.1, 1e-6);
  EXPECT_EQ(positions[1], positions[0]);
  EXPECT_EQ(positions[2], positions[0]);
  EXPECT_NEAR(positions[3], 0.4, 1e-6);
}

}  // namespace tact::rig::rig_drives_test
