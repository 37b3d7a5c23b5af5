// SPDX-License-Identifier: Apache-2.0
// Commands of another sender to the drives of an ODrive delta.
#include <gtest/gtest.h>

#include <random>

#include "tests/hal/odrive/odrive_faults_bench.h"

namespace tact::hal::odrive::odrive_foreign_test {

using Bench = tests::OdriveFaultsBench;

// At random ticks, one or a burst, with and without force: every frame that makes a drive act.
TEST(OdriveForeign, ACommandOfAnotherSenderLatchesInTheTickThatHearsIt) {
  std::mt19937 random(7);
  const auto any = [&random](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  for (int trial = 0; trial < 120; ++trial) {
    Bench bench;
    bench.run();
    for (int wait = any(0, 30); wait > 0; --wait) bench.tick({0.0, 0.0, 5.0});
    ASSERT_EQ(bench.count("foreign_commands"), 0u) << "no false alarm";
    const auto act = kOdriveActs[static_cast<std::size_t>(any(0, kOdriveActs.size() - 1))];
    auto frame = can::make_can_frame(static_cast<std::uint32_t>(any(1, 3)) << 5 | act,
                                     static_cast<std::uint8_t>(any(0, 8)));
    const int burst = any(1, 40);
    for (int i = 0; i < burst; ++i) bench.drives.bus.say(frame);
    ASSERT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kForeignCommand) << frame.id;
    for (const auto& axis : bench.drives.axis) ASSERT_EQ(axis.torque_Nm, 0.0f) << frame.id;
    ASSERT_EQ(bench.count("foreign_commands"), static_cast<std::uint64_t>(burst));
    ASSERT_TRUE(bench.says("a command that tactd did not send")) << bench.device->fault_detail();
    bench.expect_latched(Fault::kForeignCommand);
  }
}

TEST(OdriveForeign, ADriveThatAnotherSenderStartsAgainIsStoppedEachTime) {
  Bench bench;
  bench.run();
  for (int i = 0; i < 50; ++i) {
    bench.drives.bus.say(*odrive_input_torque(2, 0.7, OdriveTorqueLength::kPadded));
    bench.drives.forget();
    ASSERT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kForeignCommand);
    bench.expect_stopped();
  }
  EXPECT_TRUE(bench.says("frame 0x04E with 33 33 33 3F 00 00 00 00 on can0"))
      << bench.device->fault_detail();
}

TEST(OdriveForeign, FramesOfOtherNodesAndQuestionsAreNoCommands) {
  Bench bench;
  bench.run();
  bench.drives.bus.say(*odrive_input_torque(9, 0.7, OdriveTorqueLength::kPadded));
  bench.drives.bus.say(*odrive_request(2, OdriveCommand::kGetVersion));
  EXPECT_EQ(bench.tick({0.0, 0.0, 5.0}), Fault::kNone) << bench.device->fault_detail();
  EXPECT_EQ(bench.count("foreign_commands"), 0u);
}

}  // namespace tact::hal::odrive::odrive_foreign_test
