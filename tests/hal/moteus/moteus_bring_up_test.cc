// SPDX-License-Identifier: Apache-2.0
#include "hal/moteus/moteus_bring_up.h"

#include <gtest/gtest.h>

#include <memory>

#include "hal/can/can_settings.h"
#include "tests/hal/moteus/moteus_bench.h"

namespace tact::hal::moteus::moteus_bring_up_test {

using can::Homing;
using tests::MoteusBench;

TEST(MoteusBringUp, OpensThreeDrivesWithoutPower) {
  MoteusBench bench;
  ASSERT_EQ(bench.open(), "");
  EXPECT_EQ(bench.drives.most_enabled, 0u);
  EXPECT_EQ(bench.drives.largest_torque_Nm, 0.0);
  EXPECT_TRUE(bench.all_stopped());
  EXPECT_EQ(bench.device->info().name, "delta with three moteus on CAN FD");
  EXPECT_EQ(bench.device->info().caution, "");
}

TEST(MoteusBringUp, NamesTheArmThatIsMissingAndReportsWhenAllAre) {
  MoteusBench bench;
  bench.drives.drive[1] = std::make_unique<tests::DeadDrive>();
  bench.expect_refused("arm 2 (node 2 on can0) does not answer");
  MoteusBench empty;
  for (auto& drive : empty.drives.drive) drive = std::make_unique<tests::DeadDrive>();
  empty.expect_refused("no drive is heard on can0");
}

TEST(MoteusBringUp, ADriveOfAnotherRegisterMapIsRefused) {
  MoteusBench bench({.register_map = 4});
  bench.expect_refused("arm 1 (node 1 on can0) does not speak register map 5");
  MoteusBench silent({.unknown_register = 0x102});
  silent.expect_refused("does not speak register map 5");
}

TEST(MoteusBringUp, AReplyThatLacksWhatEveryTickAsksForIsRefusedByName) {
  MoteusBench position({.knows_position = false});
  position.expect_refused("does not know its position");
  MoteusBench voltage({.unknown_register = 0x00D});
  voltage.expect_refused("answers without its voltage");
  MoteusBench fault({.unknown_register = 0x00F});
  fault.expect_refused("answers without its voltage");  // read together, refused together
}

TEST(MoteusBringUp, AbsoluteHomingNeedsAnOutputReferenceAndIndexIsNone) {
  for (const int home_state : {0, 1}) {
    MoteusBench bench({.home_state = home_state});
    bench.settings.of<can::CanSettings>().homing = Homing::kAbsolute;
    bench.expect_refused("needs an encoder at the output");
  }
  MoteusBench index;
  index.settings.of<can::CanSettings>().homing = Homing::kIndex;
  index.expect_refused("\"index\"");
  MoteusBench good;
  good.settings.of<can::CanSettings>().homing = Homing::kAbsolute;
  for (auto& motor : good.drives.motor) motor.position_turns = 0.7;
  EXPECT_EQ(good.open(), "");
}

TEST(MoteusBringUp, NodesThatNoMoteusHasAreRefused) {
  for (const int node : {0, 127}) {
    MoteusBench bench;
    bench.settings.of<can::CanSettings>().node[1] = node;
    bench.expect_refused("a moteus' id.id is 1 to 126");
  }
}

TEST(MoteusBringUp, AFaultThatAStopClearsIsReportedAndOneThatStaysIsRefused) {
  MoteusBench bench;
  bench.drives.drive[2]->fail(0);
  ASSERT_EQ(bench.open(), "");
  EXPECT_NE(bench.device->info().caution.find("arm 3 (node 3 on can0) was in fault"),
            std::string::npos)
      << bench.device->info().caution;
  EXPECT_GT(bench.ticks_until_ready(), 0) << bench.device->fault_detail();

  MoteusBench stays;
  stays.drives.also = [&] { stays.drives.drive[0]->fail(0); };
  stays.expect_refused("arm 1 (node 1 on can0): The power stage reports a fault");
}

TEST(MoteusBringUp, TakesPowerOnlyFromDrivesThatStillHaveIt) {
  const auto command = [](MoteusBench& bench) {
    canfd_frame frame{};
    const auto bytes = can::pack_can_frame(*moteus_torque(2, 0.0, 1.0));
    std::copy(bytes->begin(), bytes->end(), reinterpret_cast<std::uint8_t*>(&frame));
    bench.drives.drive[1]->receive(frame, bench.drives.now_ns);
  };
  MoteusBench left;
  command(left);
  for (int i = 0; i < 50; ++i) left.drives.millisecond();
  ASSERT_TRUE(left.axis(1).is_enabled());
  EXPECT_EQ(left.open(), "");
  EXPECT_TRUE(left.all_stopped());

  MoteusBench busy({.prepare_ms = 0});
  busy.drives.also = [&] { command(busy); };
  const std::string message = busy.open();
  EXPECT_NE(message.find("by itself: end the program that drives it"), std::string::npos)
      << message;
}

TEST(MoteusBringUp, ArmsThatMoveOnTheJigAreRefused) {
  MoteusBench bench;
  bench.drives.also = [&] { bench.drives.motor[0].position_turns += 0.001; };
  bench.expect_refused("arm 1 (node 1 on can0) moves");
}

TEST(MoteusBringUp, ABusThatLosesEveryThirdAnswerIsRefused) {
  MoteusBench bench;
  int time_ms = 0;
  auto drive = std::move(bench.drives.drive[1]);
  struct Hard final : rig::Drive {
    explicit Hard(std::unique_ptr<rig::Drive> inner) : drive(std::move(inner)) {}
    bool receive(const canfd_frame& frame, std::int64_t now_ns) override {
      if ((frame.can_id & 0x7Fu) == 2 && ++heard % 3 == 0) return false;
      return drive->receive(frame, now_ns);
    }
    void tick(std::int64_t now_ns) override { drive->tick(now_ns); }
    void fail(std::int64_t now_ns) override { drive->fail(now_ns); }
    bool warn(std::int64_t) override { return false; }
    bool is_enabled() const override { return drive->is_enabled(); }
    double torque_Nm() const override { return drive->torque_Nm(); }
    bool tripped() override { return drive->tripped(); }
    std::unique_ptr<rig::Drive> drive;
    int heard = 0;
  };
  bench.drives.drive[1] = std::make_unique<Hard>(std::move(drive));
  bench.drives.also = [&] { ++time_ms; };
  bench.expect_refused("arm 2 (node 2 on can0) answers ");
  EXPECT_LT(time_ms, 2500);
}

}  // namespace tact::hal::moteus::moteus_bring_up_test
