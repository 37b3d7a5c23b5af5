#include "firmware/supervisor.h"

#include <gtest/gtest.h>

namespace tact::firmware {
namespace {

constexpr Commands kArm{.arm = true};
constexpr Commands kIdle{};
constexpr Commands kReset{.reset = true};

Supervisor armed_supervisor() {
  Supervisor s;
  s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  s.step(kArm, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  EXPECT_TRUE(s.armed());
  return s;
}

TEST(Supervisor, IsOffUntilTheDeviceGivesAGoodSample) {
  Supervisor s;
  EXPECT_EQ(s.step(kArm, {.sample_good = false, .ready = true, .fault = Fault::kNone}),
            State::kOff);
  EXPECT_EQ(s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kNone}),
            State::kReady);
}

TEST(Supervisor, NeedsARequestToArm) {
  Supervisor s;
  for (int i = 0; i < 5; ++i)
    s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  EXPECT_EQ(s.state(), State::kReady);
  EXPECT_EQ(s.step(kArm, {.sample_good = true, .ready = true, .fault = Fault::kNone}),
            State::kArmed);
}

TEST(Supervisor, StopsOnRequestWithoutAFault) {
  Supervisor s = armed_supervisor();
  EXPECT_EQ(s.step({.stop = true}, {.sample_good = true, .ready = true, .fault = Fault::kNone}),
            State::kStopped);
  EXPECT_EQ(s.fault(), Fault::kNone);
}

TEST(Supervisor, LatchesTheFirstFault) {
  Supervisor s = armed_supervisor();
  s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kDeviceFailed});
  s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kDeviceLost});
  EXPECT_EQ(s.state(), State::kStopped);
  EXPECT_EQ(s.fault(), Fault::kDeviceFailed);
}

TEST(Supervisor, GoesOnWhileALimitActs) {
  Supervisor s = armed_supervisor();
  EXPECT_EQ(s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kForceLimited}),
            State::kArmed);
  s.trip(Fault::kSlewLimited);
  EXPECT_EQ(s.state(), State::kArmed);
}

TEST(Supervisor, AFaultFromTheGateStopsInTheSameTick) {
  Supervisor s = armed_supervisor();
  s.trip(Fault::kForceNotFinite);
  EXPECT_FALSE(s.armed());
  EXPECT_EQ(s.fault(), Fault::kForceNotFinite);
}

TEST(Supervisor, OnlyAResetEdgeWithAllInputsGoodLeavesStopped) {
  Supervisor s = armed_supervisor();
  s.step(kReset, {.sample_good = true,
                  .ready = true,
                  .fault = Fault::kDeviceLost});  // the edge came with the fault: not good
  EXPECT_EQ(s.step(kReset, {.sample_good = true, .ready = true, .fault = Fault::kNone}),
            State::kStopped)
      << "a level is no edge";
  s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  EXPECT_EQ(s.step(kReset, {.sample_good = false, .ready = true, .fault = Fault::kNone}),
            State::kStopped)
      << "no good sample";
  s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  EXPECT_EQ(s.step({.arm = true, .reset = true},
                   {.sample_good = true, .ready = true, .fault = Fault::kNone}),
            State::kStopped)
      << "an arm request that stands is no good input";
  s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  EXPECT_EQ(s.step(kReset, {.sample_good = true, .ready = true, .fault = Fault::kNone}),
            State::kReady);
  EXPECT_EQ(s.fault(), Fault::kNone);
}

TEST(Supervisor, ResetNeverArms) {
  Supervisor s = armed_supervisor();
  s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kDeviceLost});
  s.step(kReset, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  for (int i = 0; i < 5; ++i)
    s.step(kReset, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  EXPECT_EQ(s.state(), State::kReady);
}

TEST(Supervisor, ArmsNothingThatHasNoPower) {
  Supervisor s;
  s.step(kIdle, {.sample_good = true, .ready = false, .fault = Fault::kNone});
  EXPECT_EQ(s.step(kArm, {.sample_good = true, .ready = false, .fault = Fault::kNone}),
            State::kReady);
  EXPECT_EQ(s.step(kArm, {.sample_good = true, .ready = true, .fault = Fault::kNone}),
            State::kArmed);
}

TEST(Supervisor, PowerThatComesBackBringsNoForceWithIt) {
  Supervisor s;
  s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  s.step(kArm, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  s.step(kArm, {.sample_good = true, .ready = false, .fault = Fault::kNone});
  EXPECT_EQ(s.step(kArm, {.sample_good = true, .ready = true, .fault = Fault::kNone}),
            State::kStopped);
  EXPECT_EQ(s.fault(), Fault::kPowerLost);
}

}  // namespace
}  // namespace tact::firmware
