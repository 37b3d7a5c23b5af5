// SPDX-License-Identifier: Apache-2.0
#include "hal/gpio/safety_logic.h"

#include <gtest/gtest.h>

#include <string>

#include "hal/sim/sim_lines.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::gpio::safety_logic_test {

using model::Fault;

constexpr std::int64_t kMs = 1'000'000;
constexpr SafetyLevels kGood{.estop_a = true, .estop_b = true, .dead_man = true};
constexpr LinesTick kHealthy{.healthy = true, .armed = true, .faulted = false};

/// Ticks of 1 ms, as the loop makes them.
struct Bench {
  SafetyLogic logic{{.estop = true, .dead_man = true}};
  std::int64_t now_ns = 5 * kMs;
  Fault fault = Fault::kNone;
  SafetyOutputs outputs;

  void tick(const SafetyLevels& levels, bool in_time = true) {
    fault = logic.evaluate(levels, now_ns);
    const bool faulted = fault != Fault::kNone;
    outputs = logic.drive({.healthy = in_time && !faulted, .armed = true, .faulted = faulted});
    now_ns += kMs;
  }
  void ticks(int n, const SafetyLevels& levels) {
    for (int i = 0; i < n; ++i) tick(levels);
  }
};

TEST(SafetyLogic, EnableComesAfter100msOfHeartbeatAndNotBefore) {
  Bench bench;
  for (int i = 0; i < 100; ++i) {
    bench.tick(kGood);
    ASSERT_EQ(bench.outputs.heartbeat, i % 2 == 0) << i;
    ASSERT_FALSE(bench.outputs.enable || bench.logic.enabled()) << i;
  }
  bench.tick(kGood);  // 100 ms after the first edge
  EXPECT_TRUE(bench.outputs.enable);
  EXPECT_TRUE(bench.logic.enabled());
}

TEST(SafetyLogic, NothingIsEnabledWhileAnInputIsOpen) {
  for (const SafetyLevels& open : {SafetyLevels{true, false, true}, SafetyLevels{false, true, true},
                                   SafetyLevels{false, false, true}, SafetyLevels{true, true}}) {
    Bench bench;
    for (int i = 0; i < 300; ++i) {
      bench.tick(open);
      ASSERT_FALSE(bench.outputs.enable || bench.outputs.heartbeat) << i;
    }
  }
}

TEST(SafetyLogic, EitherChannelStopsInTheSameTick) {
  for (const bool a : {true, false}) {
    Bench bench;
    bench.ticks(200, kGood);
    ASSERT_TRUE(bench.logic.enabled());
    const bool beat = bench.outputs.heartbeat;
    bench.tick({.estop_a = !a, .estop_b = a, .dead_man = true});
    EXPECT_EQ(bench.fault, Fault::kEmergencyStop);
    EXPECT_FALSE(bench.outputs.enable);
    EXPECT_EQ(bench.outputs.heartbeat, beat) << "no edge after a fault";
  }
}

TEST(SafetyLogic, PermissionIsGoneBeforeTheOutputsAreWritten) {
  Bench bench;
  bench.ticks(200, kGood);
  bench.logic.evaluate({.estop_a = false, .estop_b = true, .dead_man = true}, bench.now_ns);
  EXPECT_FALSE(bench.logic.enabled());
}

TEST(SafetyLogic, AReleasedDeadManStopsInTheSameTick) {
  Bench bench;
  bench.ticks(200, kGood);
  bench.tick({.estop_a = true, .estop_b = true, .dead_man = false});
  EXPECT_EQ(bench.fault, Fault::kDeadManReleased);
  EXPECT_FALSE(bench.outputs.enable);
  bench.tick({.estop_a = false, .estop_b = false, .dead_man = false});
  EXPECT_EQ(bench.fault, Fault::kEmergencyStop) << "the e-stop is named before the dead-man";
}

TEST(SafetyLogic, ChannelsMayDifferFor50msAndNoLonger) {
  Bench bench;
  bench.ticks(10, kGood);
  const SafetyLevels only_b{.estop_a = false, .estop_b = true, .dead_man = true};
  for (int i = 0; i <= 50; ++i) {
    bench.tick(only_b);
    ASSERT_EQ(bench.fault, Fault::kEmergencyStop) << i << " ms";
  }
  bench.tick(only_b);  // 51 ms
  EXPECT_EQ(bench.fault, Fault::kLinesDiffer);
}

TEST(SafetyLogic, AWeldedContactIsNotForgottenWhenTheEStopIsReleased) {
  Bench bench;
  bench.ticks(10, kGood);
  bench.ticks(60, {.estop_a = false, .estop_b = true, .dead_man = true});
  bench.ticks(500, kGood);  // released: both are closed again, B is still welded
  EXPECT_EQ(bench.fault, Fault::kLinesDiffer);
  EXPECT_EQ(bench.logic.cause(), LinesCause::kBStaysClosed);
  EXPECT_FALSE(bench.outputs.enable);
  bench.ticks(3, {.estop_a = false, .estop_b = false, .dead_man = true});  // repaired and pressed
  EXPECT_EQ(bench.fault, Fault::kEmergencyStop);
  bench.tick(kGood);
  EXPECT_EQ(bench.fault, Fault::kNone);
}

TEST(SafetyLogic, ReportsWhichChannelSticks) {
  const SafetyLevels only_a{true, false, true}, only_b{false, true, true}, open{false, false, true};
  const struct {
    SafetyLevels before, after;
    LinesCause cause;
    const char* word;
  } cases[] = {{kGood, only_b, LinesCause::kBStaysClosed, "channel B of the e-stop did not open"},
               {kGood, only_a, LinesCause::kAStaysClosed, "channel A of the e-stop did not open"},
               {open, only_a, LinesCause::kBStaysOpen, "channel B of the e-stop stays open"},
               {open, only_b, LinesCause::kAStaysOpen, "channel A of the e-stop stays open"}};
  for (const auto& c : cases) {
    Bench bench;
    bench.ticks(10, c.before);
    bench.ticks(60, c.after);
    EXPECT_EQ(bench.fault, Fault::kLinesDiffer);
    EXPECT_EQ(bench.logic.cause(), c.cause);
    EXPECT_NE(std::string(text_of(bench.logic.cause())).find(c.word), std::string::npos);
  }
}

TEST(SafetyLogic, AChannelBrokenFromTheStartIsFound) {
  Bench bench;
  bench.ticks(60, {.estop_a = true, .estop_b = false, .dead_man = true});
  EXPECT_EQ(bench.fault, Fault::kLinesDiffer);
  EXPECT_EQ(bench.logic.cause(), LinesCause::kBStaysOpen);
}

TEST(SafetyLogic, AShortPressIsRememberedAsWhatItWas) {
  Bench bench;
  bench.ticks(10, kGood);
  bench.ticks(2, {.estop_a = false, .estop_b = true, .dead_man = true});
  bench.ticks(5, {.estop_a = false, .estop_b = false, .dead_man = true});
  bench.ticks(2, {.estop_a = true, .estop_b = false, .dead_man = true});
  bench.ticks(5, kGood);
  EXPECT_EQ(bench.fault, Fault::kNone);
  EXPECT_EQ(bench.logic.cause(), LinesCause::kBothOpen);
}

TEST(SafetyLogic, AFaultOfAnotherPartDropsEnableAndTakesANew100ms) {
  Bench bench;
  bench.ticks(200, kGood);
  bench.logic.evaluate(kGood, bench.now_ns);
  EXPECT_FALSE(bench.logic.drive({.healthy = false, .armed = false, .faulted = true}).enable);
  bench.now_ns += kMs;
  bench.ticks(100, kGood);
  EXPECT_FALSE(bench.outputs.enable);
  bench.tick(kGood);
  EXPECT_TRUE(bench.outputs.enable);
}

TEST(SafetyLogic, OneLateTickCostsAnEdgeAndNotThePower) {
  Bench bench;
  bench.ticks(200, kGood);
  const bool beat = bench.outputs.heartbeat;
  bench.tick(kGood, false);
  EXPECT_EQ(bench.outputs.heartbeat, beat);
  EXPECT_TRUE(bench.outputs.enable);
  for (int i = 0; i < 10; ++i) bench.tick(kGood, false);  // 11 ms without an edge
  EXPECT_FALSE(bench.outputs.enable);
}

TEST(SafetyLogic, ALoopThatWasStoppedComesBackWithoutPower) {
  Bench bench;
  bench.ticks(200, kGood);
  bench.now_ns += 1000 * kMs;
  bench.tick(kGood);
  EXPECT_FALSE(bench.outputs.enable);
  bench.ticks(100, kGood);
  EXPECT_TRUE(bench.outputs.enable);
}

TEST(SafetyLogic, UnwiredInputsCauseNoFault) {
  SafetyLogic bare({});
  EXPECT_EQ(bare.evaluate({}, 0), Fault::kNone);
  SafetyLogic estop({.estop = true, .dead_man = false});
  EXPECT_EQ(estop.evaluate({.estop_a = true, .estop_b = true, .dead_man = false}, 0), Fault::kNone);
}

TEST(SafetyLogic, TheLightShowsArmed) {
  SafetyLogic logic({});
  logic.evaluate({}, 0);
  EXPECT_TRUE(logic.drive({.healthy = true, .armed = true}).led);
  EXPECT_FALSE(logic.drive({.healthy = true, .armed = false}).led);
}

TEST(SafetyLogic, EveryCauseHasAMessageWithARemedy) {
  for (int i = 1; i <= static_cast<int>(LinesCause::kChipLost); ++i) {
    const std::string message = text_of(static_cast<LinesCause>(i));
    EXPECT_NE(message.find("then "), std::string::npos) << message;
  }
  EXPECT_STREQ(text_of(LinesCause::kNone), "");
}

TEST(SimLines, AreLostForGoodWithTheirChip) {
  sim::SimLines lines;
  std::int64_t now_ns = 0;
  const auto tick = [&] {
    const Fault fault = lines.read(now_ns += kMs);
    const Fault wrote = lines.write(kHealthy);
    return fault != Fault::kNone ? fault : wrote;
  };
  for (int i = 0; i < 150; ++i) ASSERT_EQ(tick(), Fault::kNone);
  ASSERT_TRUE(lines.enabled() && lines.outputs().enable);
  lines.inputs().chip_lost = true;
  EXPECT_EQ(tick(), Fault::kLinesLost);
  EXPECT_FALSE(lines.enabled() || lines.outputs().enable);
  lines.inputs().chip_lost = false;
  EXPECT_EQ(tick(), Fault::kLinesLost);
  EXPECT_NE(lines.fault_detail().find("gpiodetect"), std::string::npos);
}

TEST(SimLines, OnceDroppedByTheWatchStayLowForAnyWriteOfTheLoop) {
  sim::SimLines lines;
  std::int64_t now_ns = 0;
  const auto tick = [&] {
    lines.read(now_ns += kMs);
    lines.write(kHealthy);
  };
  for (int i = 0; i < 150; ++i) tick();
  ASSERT_TRUE(lines.enabled() && lines.outputs().enable);
  lines.drop();
  EXPECT_FALSE(lines.enabled() || lines.outputs().enable || lines.outputs().heartbeat) << "at once";
  for (int i = 0; i < 300; ++i) {
    tick();
    ASSERT_FALSE(lines.enabled() || lines.outputs().enable || lines.outputs().heartbeat);
  }
}

TEST(SimLines, LeaveTheHeapAlone) {
  sim::SimLines lines;
  const tests::NoAlloc guard;
  for (int i = 0; i < 200; ++i) {
    lines.scope(true);
    lines.read(i * kMs);
    lines.write(kHealthy);
    lines.scope(false);
  }
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::hal::gpio::safety_logic_test
