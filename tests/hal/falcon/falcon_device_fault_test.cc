// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "tests/hal/falcon/falcon_bench.h"

namespace tact::tests::falcon_device_fault_test {

constexpr falcon::FalconWords kNoWords{};
constexpr Vec3 kPush_N{2.0, 0.0, 0.0};

bool names(const FalconBench& bench, const char* what) {
  return bench.device.fault_detail().find(what) != std::string::npos;
}

/// The fault stays, without force, for any further reply, and zeros go out in every tick.
void expect_latched(FalconBench& bench, Fault fault) {
  bench.pipe->state = {};
  bench.pipe->gone_at_submit = bench.pipe->full = false;
  bench.answers = true;
  bench.report = homed_at({});
  for (int i = 0; i < 50; ++i) {
    const int commands = bench.pipe->commands;
    EXPECT_FALSE(bench.tick(kPush_N));
    EXPECT_EQ(bench.pipe->commands, commands + 1);
    EXPECT_EQ(bench.fault, fault);
    EXPECT_FALSE(bench.device.ready());
    EXPECT_EQ(bench.words(), kNoWords);
    EXPECT_EQ(bench.pipe->command.lights, falcon::kFalconRed);
  }
}

TEST(FalconDeviceFault, OneMissedAnswerIsNoFaultAndTheForceGoesOn) {
  FalconBench bench;
  bench.home();
  bench.run(5, kPush_N);
  bench.answers = false;
  EXPECT_FALSE(bench.tick(kPush_N));
  EXPECT_NE(bench.words(), kNoWords);  // the gate decides
  EXPECT_FALSE(bench.tick(kPush_N));
  EXPECT_NE(bench.words(), kNoWords);
  bench.answers = true;
  EXPECT_TRUE(bench.tick(kPush_N));
  EXPECT_EQ(bench.fault, Fault::kNone);
}

TEST(FalconDeviceFault, AfterThreeMissesTheWordsAreZeroUntilAnAnswerComes) {
  FalconBench bench;
  bench.home();
  bench.run(5, kPush_N);
  bench.answers = false;
  bench.run(2, kPush_N);
  EXPECT_NE(bench.words(), kNoWords);
  const int commands = bench.pipe->commands;
  for (int i = 0; i < 27; ++i) {
    bench.tick(kPush_N);
    EXPECT_EQ(bench.words(), kNoWords) << i;
    EXPECT_EQ(bench.fault, Fault::kNone);  // to give up is the gate's part
  }
  EXPECT_EQ(bench.pipe->commands, commands + 27);  // it is asked again and again
  bench.answers = true;
  EXPECT_TRUE(bench.tick(kPush_N));
  EXPECT_NE(bench.words(), kNoWords);
}

TEST(FalconDeviceFault, ADeviceThatStaysMuteIsLostAlsoBeforeItIsHomed) {
  for (const bool homed : {false, true}) {
    FalconBench bench;
    if (homed) bench.home();
    bench.run(5);
    bench.answers = false;
    bench.run(495);
    EXPECT_EQ(bench.fault, Fault::kNone);
    bench.run(10);
    EXPECT_EQ(bench.fault, Fault::kDeviceLost);
    EXPECT_TRUE(names(bench, "power supply"));
    expect_latched(bench, Fault::kDeviceLost);
  }
}

TEST(FalconDeviceFault, AFasterLoopAsksNoMoreThanTheDeviceCanAnswer) {
  FalconBench bench;
  bench.home();
  bench.answers = false;
  const int before = bench.pipe->commands;
  for (int i = 0; i < 8; ++i) {  // 0.125 ms a tick
    bench.now_ns -= 875'000;
    bench.tick();
  }
  EXPECT_EQ(bench.pipe->commands, before + 2);  // with the one of home(): three under way
  bench.run(2);
  EXPECT_GE(bench.pipe->commands, before + 3);  // the oldest is late: asked again
}

TEST(FalconDeviceFault, ARepetitionIsNotASecondSample) {
  FalconBench bench;
  bench.home();
  bench.tick();
  bench.read();
  ASSERT_TRUE(bench.sample.fresh);
  const std::uint64_t sequence = bench.sample.sequence;
  bench.pipe->answer(bench.report, bench.now_ns - 100'000);  // no command went out since
  bench.read();
  EXPECT_FALSE(bench.sample.fresh);
  bench.write();
  EXPECT_TRUE(bench.tick());
  EXPECT_GT(bench.sample.sequence, sequence);
}

TEST(FalconDeviceFault, TwoAnswersInATickAreOneSample) {
  FalconBench bench;
  bench.home();
  bench.answers = false;
  bench.pipe->answer(bench.report, bench.now_ns + 500'000, 2);
  EXPECT_TRUE(bench.tick());
  EXPECT_FALSE(bench.tick());
}

TEST(FalconDeviceFault, AnOldAnswerIsNotFresh) {
  FalconBench bench;
  bench.home();
  bench.answers = false;
  bench.tick();
  bench.pipe->answer(bench.report, bench.now_ns);
  bench.now_ns += 9'000'000;  // the loop was away
  bench.tick();
  EXPECT_FALSE(bench.sample.fresh);
  bench.now_ns += 50'000'000;  // all of it was away: the stamp is new, the command old
  bench.pipe->answer(bench.report, bench.now_ns);
  bench.tick();
  EXPECT_FALSE(bench.sample.fresh);
  bench.answers = true;
  EXPECT_TRUE(bench.tick());
  EXPECT_EQ(bench.fault, Fault::kNone);
}

TEST(FalconDeviceFault, AnImpossibleJumpIsNotBelieved) {
  FalconBench bench;
  bench.home();
  bench.run(5);
  const Vec3 before_m = bench.sample.tool.position_m;
  bench.report.counts[1] += 600;  // 35 mm in a millisecond
  EXPECT_FALSE(bench.tick(kPush_N));
  EXPECT_EQ(bench.sample.tool.position_m, before_m);
  bench.report.counts[1] -= 600;
  EXPECT_TRUE(bench.tick(kPush_N));
  EXPECT_EQ(bench.fault, Fault::kNone);
}

TEST(FalconDeviceFault, CountsThatNoPoseHasAreGarbage) {
  FalconBench bench;
  bench.home();
  bench.report.counts = {32000, -32000, 32000};
  for (int i = 0; i < 60 && bench.fault == Fault::kNone; ++i) EXPECT_FALSE(bench.tick(kPush_N));
  EXPECT_EQ(bench.fault, Fault::kDeviceGarbled);
  expect_latched(bench, Fault::kDeviceGarbled);
}

TEST(FalconDeviceFault, GarbageWithoutReportsLatchesBeforeTheGateGivesUp) {
  FalconBench bench;
  bench.home();
  bench.answers = false;
  int missed = 0;
  while (bench.fault == Fault::kNone && missed < 100) {
    bench.pipe->state.dropped_bytes += 16;
    bench.pipe->state.line_errors = 0x08;
    bench.tick(kPush_N);
    ++missed;
  }
  EXPECT_EQ(bench.fault, Fault::kDeviceGarbled);
  EXPECT_GE(missed, 15);
  EXPECT_LT(missed, 20);
  EXPECT_TRUE(names(bench, "different speeds")) << bench.device.fault_detail();
  expect_latched(bench, Fault::kDeviceGarbled);
}

TEST(FalconDeviceFault, SomeDamageBetweenGoodReportsIsNoFault) {
  FalconBench bench;
  bench.home();
  for (int i = 0; i < 200; ++i) {
    bench.pipe->state.dropped_bytes += 3;
    bench.answers = i % 3 != 0;
    bench.tick(kPush_N);
    EXPECT_EQ(bench.fault, Fault::kNone);
  }
}

TEST(FalconDeviceFault, LosingHomeLatchesAtOnce) {
  FalconBench bench;
  bench.home();
  bench.run(5, kPush_N);
  bench.report.homed = 0x3;
  EXPECT_FALSE(bench.tick(kPush_N));
  EXPECT_EQ(bench.fault, Fault::kHomingLost);
  EXPECT_EQ(bench.words(), kNoWords);
  EXPECT_TRUE(names(bench, "lost its home (axis 3 (left))"));
  expect_latched(bench, Fault::kHomingLost);
}

TEST(FalconDeviceFault, EveryEndOfThePipeLatchesWithItsCause) {
  struct Case {
    falcon::FalconPipeHealth health;
    Fault fault;
    const char* words;
  };
  for (const Case& c :
       {Case{{.end = falcon::FalconPipeEnd::kUnplugged, .error = 19},
             Fault::kDeviceUnplugged,
             "gone"},
        Case{{.end = falcon::FalconPipeEnd::kStalled, .error = 32}, Fault::kDeviceFailed, "stall"},
        Case{{.end = falcon::FalconPipeEnd::kBroken, .error = 71},
             Fault::kDeviceFailed,
             "Protocol error"}}) {
    FalconBench bench;
    bench.home();
    bench.run(5, kPush_N);
    bench.pipe->state = c.health;
    EXPECT_FALSE(bench.tick(kPush_N));
    EXPECT_EQ(bench.fault, c.fault);
    EXPECT_TRUE(names(bench, c.words)) << bench.device.fault_detail();
    expect_latched(bench, c.fault);
  }
}

TEST(FalconDeviceFault, AfterItsThreadStoodInForTheLoopTheOldForceDoesNotComeBack) {
  FalconBench bench;
  bench.home();
  bench.run(5, kPush_N);
  EXPECT_NE(bench.words(), kNoWords);
  bench.pipe->state.stood_in = true;  // and the loop comes back, with what it held
  EXPECT_FALSE(bench.tick(kPush_N));
  EXPECT_EQ(bench.fault, Fault::kLoopStalled);
  EXPECT_EQ(bench.words(), kNoWords);
  EXPECT_TRUE(names(bench, "gave the Falcon no command for 100 ms")) << bench.device.fault_detail();
  expect_latched(bench, Fault::kLoopStalled);
}

TEST(FalconDeviceFault, AStallOrABrokenPipeBringsZerosAtOnceAndWhenItStops) {
  for (const falcon::FalconPipeEnd end :
       {falcon::FalconPipeEnd::kStalled, falcon::FalconPipeEnd::kBroken}) {
    FalconBench bench;
    bench.home();
    bench.run(5, kPush_N);
    ASSERT_NE(bench.words(), kNoWords);
    bench.answers = false;
    bench.pipe->state = {.end = end, .error = 32};
    bench.tick(kPush_N);
    EXPECT_EQ(bench.fault, Fault::kDeviceFailed);
    EXPECT_EQ(bench.words(), kNoWords);
    for (int i = 0; i < 8; ++i) {  // a faster loop waits for no answer either
      bench.now_ns -= 875'000;
      const int commands = bench.pipe->commands;
      bench.tick(kPush_N);
      EXPECT_EQ(bench.pipe->commands, commands + 1);
      EXPECT_EQ(bench.words(), kNoWords);
    }
    bench.device.stop();
    EXPECT_EQ(bench.pipe->stops, 1);
    EXPECT_EQ(bench.pipe->last.motor, kNoWords);
  }
}

TEST(FalconDeviceFault, UnpluggedIsKnownInTheTickWhoseCommandFails) {
  FalconBench bench;
  bench.home();
  bench.read();
  bench.pipe->gone_at_submit = true;
  EXPECT_EQ(bench.write(kPush_N), Fault::kDeviceUnplugged);
  expect_latched(bench, Fault::kDeviceUnplugged);
}

TEST(FalconDeviceFault, AFullPipeIsAMissedCycleAndNoFault) {
  FalconBench bench;
  bench.home();
  bench.pipe->full = true;
  bench.run(2, kPush_N);
  EXPECT_EQ(bench.fault, Fault::kNone);
  bench.pipe->full = false;
  bench.run(2, kPush_N);
  EXPECT_TRUE(bench.sample.fresh);
}

}  // namespace tact::tests::falcon_device_fault_test
