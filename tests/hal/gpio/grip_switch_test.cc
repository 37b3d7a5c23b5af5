// SPDX-License-Identifier: Apache-2.0
#include "hal/gpio/grip_switch.h"

#include <gtest/gtest.h>

#include "hal/gpio/safety_logic.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::gpio::grip_switch_test {

using model::Fault;

constexpr std::int64_t kMs = 1'000'000;

/// Ticks of 1 ms, as the loop makes them.
struct Bench {
  GripSwitch grip;
  std::int64_t now_ns = 0;

  void ticks(int n, bool pressed) {
    for (int i = 0; i < n; ++i, now_ns += kMs) grip.step(pressed, now_ns);
  }
  /// A press and a release, each with 6 ms in which the contact bounces.
  void press(int pause_ms) {
    for (const bool pressed : {true, false}) {
      for (int i = 0; i < 3; ++i) ticks(1, pressed), ticks(1, !pressed);
      ticks(pause_ms, pressed);
    }
  }
};

TEST(GripSwitch, ALevelCountsAfter10ms) {
  Bench bench;
  bench.ticks(20, false);
  bench.ticks(10, true);
  EXPECT_FALSE(bench.grip.pressed());
  bench.ticks(1, true);  // 10 ms after the edge
  EXPECT_TRUE(bench.grip.pressed());
  bench.ticks(10, false);
  EXPECT_TRUE(bench.grip.pressed());
  bench.ticks(1, false);
  EXPECT_FALSE(bench.grip.pressed());
}

TEST(GripSwitch, ASpikeClosesNothing) {
  Bench bench;
  bench.ticks(20, false);
  bench.ticks(9, true);
  bench.ticks(50, false);
  EXPECT_FALSE(bench.grip.pressed() || bench.grip.flaps());
}

TEST(GripSwitch, AFootThatPressesFiveTimesASecondDoesNotFlap) {
  Bench bench;
  for (int i = 0; i < 50; ++i) {
    bench.press(94);  // two edges in 200 ms
    ASSERT_FALSE(bench.grip.flaps()) << i;
  }
}

TEST(GripSwitch, ALineThatNeverSettlesFlapsAfter100ms) {
  Bench bench;
  bench.ticks(20, false);
  for (int i = 0; i < 50; ++i) {
    ASSERT_FALSE(bench.grip.flaps()) << 2 * i << " ms";
    bench.ticks(1, true), bench.ticks(1, false);
  }
  bench.ticks(1, true);
  EXPECT_TRUE(bench.grip.flaps());
  EXPECT_FALSE(bench.grip.pressed());
}

TEST(GripSwitch, ALineThatChangesEvery30msFlapsUntilItWasQuietForASecond) {
  Bench bench;
  for (int i = 0; i < 8; ++i) {
    ASSERT_FALSE(bench.grip.flaps()) << i;
    bench.ticks(30, true), bench.ticks(30, false);
  }
  EXPECT_TRUE(bench.grip.flaps()) << "16 changes in half a second";
  bench.ticks(1000, false);
  EXPECT_FALSE(bench.grip.flaps());
}

TEST(GripSwitch, ItsFaultComesAfterTheEmergencyStop) {
  SafetyLogic logic{{.estop = true, .grip = true}};
  SafetyLevels levels{.estop_a = true, .estop_b = true};
  std::int64_t now_ns = 0;
  const tests::NoAlloc guard;
  for (; now_ns < 150 * kMs; now_ns += kMs) {
    levels.grip = !levels.grip;
    const Fault fault = logic.evaluate(levels, now_ns);
    EXPECT_EQ(fault, now_ns < 100 * kMs ? Fault::kNone : Fault::kGripFlaps) << now_ns;
  }
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_EQ(logic.cause(), LinesCause::kGripFlaps);
  levels.estop_a = levels.estop_b = false;
  EXPECT_EQ(logic.evaluate(levels, now_ns), Fault::kEmergencyStop);
  EXPECT_EQ(logic.cause(), LinesCause::kBothOpen);
}

TEST(ClutchSwitch, AFlappingLineCountsAsPressedUntilQuietForASecond) {
  SafetyLogic logic{{.clutch = true}};
  std::int64_t now_ns = 0;
  const auto ticks = [&](int n, bool pressed) {
    for (int i = 0; i < n; ++i)
      EXPECT_EQ(logic.evaluate({.clutch = pressed}, now_ns += kMs), Fault::kNone);
  };
  ticks(20, false);
  EXPECT_EQ(logic.clutch(), false);
  for (int i = 0; i < 60; ++i) ticks(1, true), ticks(1, false);
  EXPECT_EQ(logic.clutch(), true) << "it does not settle";
  EXPECT_TRUE(std::string(logic.notice()).starts_with("the clutch line changes faster"));
  ticks(20, false);
  EXPECT_EQ(logic.clutch(), false);
  EXPECT_STREQ(logic.notice(), "");
  for (int i = 0; i < 9; ++i) ticks(30, true), ticks(30, false);
  ticks(500, false);
  EXPECT_EQ(logic.clutch(), true) << "16 changes in half a second";
  ticks(500, false);
  EXPECT_EQ(logic.clutch(), false);
}

TEST(GripSwitch, WithoutAWireThereIsNoGrip) {
  EXPECT_FALSE(SafetyLogic({}).grip());
  EXPECT_EQ(SafetyLogic({.grip = true}).grip(), false);
}

}  // namespace tact::hal::gpio::grip_switch_test
