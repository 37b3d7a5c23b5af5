// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/controller.h"

#include <gtest/gtest.h>

#include <memory>

#include "model/scene/tissue.h"
#include "tests/support/no_alloc.h"
#include "tests/support/test_scene.h"

namespace tact::firmware::loop::controller_test {

constexpr double kPeriod_s = 1e-3;
constexpr double kBall_m = 0.004;

// A spring that can be set to break, and counts the blades that went through it.
class PuppetLaw final : public model::contact::ContactLaw {
 public:
  model::contact::ContactLawResponse respond(
      const model::contact::Indentation& in) RT_SAFE override {
    return {.law = {.force_N = 200.0 * in.indentation_m,
                    .status = is_beyond ? model::law::LawStatus::kSaturated
                                        : model::law::LawStatus::kOk}};
  }
  void leave(std::size_t) RT_SAFE override {}
  void cut(const model::contact::BladeSweep&) RT_SAFE override { ++cuts; }
  void advance() RT_SAFE override {}
  bool is_broken() const RT_SAFE override { return breaks; }
  std::size_t profile(const model::contact::Indentation&,
                      std::span<double>) const RT_SAFE override {
    return 0;
  }
  double ring_pitch_m() const RT_SAFE override { return 1e-3; }

  bool breaks = false, is_beyond = false;
  int cuts = 0;
};

// A controller on a plate, ticked by hand: the test is device and clock.
class ControllerTest : public testing::Test {
 protected:
  ControllerTest() { use(true); }

  void use(bool hard_real_time) {
    model::contact::ContactScene contact = tissue_->contact_scene();
    contact.law = &law;
    contact.blade = model::contact::Blade{.a_m = {0, 0, 0}, .b_m = {0, 0.01, 0}};
    controller = std::make_unique<Controller>(contact, gate::Gate(scene_.limits, kPeriod_s, 1.0),
                                              hard_real_time);
  }
  TickOutput tick(std::uint32_t skipped = 0) {
    input.sample.fresh = true;
    input.sample.tool.position_m.z = kBall_m - depth_m;
    input.skipped_periods = skipped;
    return controller->tick(input);
  }
  // Down from above, as a hand does, until the ramp is over.
  void press() {
    depth_m = -0.002;
    tick();
    input.commands.arm = true;
    for (int i = 0; i < 600; ++i) tick();
    for (; depth_m < 0.003; depth_m += 5e-5) tick();
    for (int i = 0; i < 20; ++i) tick();
    ASSERT_GT(tick().written.force_N.z, 0.5);
  }

  PuppetLaw law;
  TickInput input;
  double depth_m = 0.0;
  std::unique_ptr<Controller> controller;

 private:
  model::scene::Scene scene_ = tests::make_plate_scene();
  std::unique_ptr<model::scene::Tissue> tissue_ = std::move(*model::scene::make_tissue(scene_));
};

TEST_F(ControllerTest, ALawThatBreaksStopsTheForceInTheSameTick) {
  press();
  const tests::NoAlloc guard;
  law.breaks = true;
  const TickOutput broken = tick();
  EXPECT_EQ(broken.written, model::Wrench{});
  EXPECT_EQ(broken.fault, Fault::kLawBroke);
  EXPECT_EQ(broken.state, State::kStopped);
  law.breaks = false;
  EXPECT_EQ(tick().fault, Fault::kLawBroke) << "latched";
  EXPECT_EQ(tick().written, model::Wrench{});
  EXPECT_EQ(guard.calls(), 0u);
}

TEST_F(ControllerTest, ABrokenLawIsNeverArmed) {
  law.breaks = true;
  depth_m = 0.003;
  tick();
  input.commands.arm = true;
  for (int i = 0; i < 10; ++i) EXPECT_EQ(tick().written, model::Wrench{});
  EXPECT_EQ(tick().state, State::kStopped);
}

TEST_F(ControllerTest, BeyondTheLawIsReportedBeforeALimitThatLeavesTheForceOn) {
  press();
  EXPECT_EQ(tick().limit, Fault::kNone);
  law.is_beyond = true;
  EXPECT_EQ(tick().limit, Fault::kLawSaturated);
  input.sample.fresh = false;
  EXPECT_EQ(controller->tick(input).limit, Fault::kLawSaturated) << "a sample is held, too";
  EXPECT_EQ(controller->tick(input).limit, Fault::kSampleStale) << "its force ramps down";
  input.sample.fresh = true;
  input.commands.arm = false;
  law.is_beyond = false;
  for (int i = 0; i < 20; ++i) EXPECT_NE(tick().limit, Fault::kLawSaturated);
}

TEST_F(ControllerTest, ArmingChangesNothingOfContact) {
  for (depth_m = -0.002; depth_m < 0.003; depth_m += 5e-5) tick();
  const TickOutput before = tick();
  EXPECT_GT(before.wanted.force_N.z, 0.5);
  EXPECT_EQ(before.written, model::Wrench{});
  input.commands.arm = true;
  const TickOutput armed = tick();
  EXPECT_EQ(armed.state, State::kArmed);
  EXPECT_EQ(armed.wanted, before.wanted);
  EXPECT_LT(armed.written.force_N.z, 0.02) << "the ramp limits it";
  for (int i = 0; i < 600; ++i) tick();
  EXPECT_NEAR(tick().written.force_N.z, before.wanted.force_N.z, 1e-9);
}

TEST_F(ControllerTest, SkippedPeriodsAndMissedSamplesKeepContact) {
  press();
  const model::Wrench before = tick().written;
  EXPECT_NEAR(tick(1).written.force_N.z, before.force_N.z, 1e-9);
  EXPECT_NEAR(tick(9).wanted.force_N.z, before.force_N.z, 1e-9);
  input.sample.fresh = false;
  input.skipped_periods = 0;
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(controller->tick(input).wanted.force_N.z, before.force_N.z, 1e-9);
  for (int i = 0; i < 20; ++i) tick();
  EXPECT_NEAR(tick().written.force_N.z, before.force_N.z, 1e-9);
  EXPECT_EQ(tick().contact_losses, 0u);
}

// 1.5 m/s and a period of 1 ms, 5 % and 0.1 mm more: 1.675 mm a period.
TEST_F(ControllerTest, AJumpBeyondSpeedTimesPauseIsContactLost) {
  press();
  depth_m -= 0.0016;
  EXPECT_EQ(tick().contact_losses, 0u);
  depth_m += 0.0016;
  EXPECT_EQ(tick().contact_losses, 0u);
  depth_m -= 0.010;
  const TickOutput lost = tick();
  EXPECT_EQ(lost.contact_losses, 1u);
  EXPECT_EQ(lost.limit, Fault::kContactLost);
  EXPECT_EQ(lost.wanted, model::Wrench{});
  EXPECT_EQ(lost.fault, Fault::kNone);
  const TickOutput after = tick();
  EXPECT_EQ(after.contact_losses, 1u);
  EXPECT_NE(after.limit, Fault::kContactLost) << "it is reported in its tick alone";
}

TEST_F(ControllerTest, ContactLostIsReportedWhereTheGateLetsGo) {
  press();
  depth_m -= 0.010;
  input.sample.tool.velocity_mps.z = 10.0;
  EXPECT_EQ(tick().limit, Fault::kContactLost);
  EXPECT_EQ(tick().limit, Fault::kTooFast);
}

TEST_F(ControllerTest, SkippedPeriodsExtendTheReach) {
  press();
  depth_m -= 0.010;
  EXPECT_EQ(tick(6).contact_losses, 0u) << "7 periods: 11.1 mm";
  depth_m += 0.010;
  EXPECT_EQ(tick(4).contact_losses, 1u) << "5 periods: 8.0 mm";
}

TEST_F(ControllerTest, MissedSamplesExtendTheReach) {
  press();
  input.sample.fresh = false;
  for (int i = 0; i < 3; ++i) controller->tick(input);
  depth_m -= 0.010;
  EXPECT_EQ(tick(3).contact_losses, 0u) << "3 missed, 3 skipped and this one";
  depth_m += 0.010;
  EXPECT_EQ(tick(3).contact_losses, 1u) << "they count once";
}

TEST_F(ControllerTest, AToolInsideIsReportedBeforeArmingAndHasNoForceUntilOutside) {
  depth_m = 0.010;  // the centre of the ball 6 mm below the surface
  EXPECT_EQ(tick().limit, Fault::kToolInside);
  EXPECT_EQ(tick().state, State::kReady);
  EXPECT_TRUE(controller->is_inside());
  input.commands.arm = true;
  for (int i = 0; i < 600; ++i) tick();
  EXPECT_EQ(tick().state, State::kArmed);
  EXPECT_EQ(tick().limit, Fault::kToolInside);
  EXPECT_EQ(tick().wanted, model::Wrench{});
  for (; depth_m > -0.002; depth_m -= 5e-5) EXPECT_EQ(tick().written, model::Wrench{});
  EXPECT_EQ(tick().limit, Fault::kNone);
  EXPECT_FALSE(controller->is_inside());
  for (; depth_m < 0.003; depth_m += 5e-5) tick();
  EXPECT_GT(tick().wanted.force_N.z, 0.5);
  EXPECT_EQ(tick().contact_losses, 0u);
}

TEST_F(ControllerTest, ContactLostIsReportedBeforeInsideAndInsideBeforeBeyondTheLaw) {
  press();
  law.is_beyond = true;
  EXPECT_EQ(tick().limit, Fault::kLawSaturated);
  depth_m = 0.012;
  EXPECT_EQ(tick().limit, Fault::kContactLost);
  EXPECT_EQ(tick().limit, Fault::kToolInside);
  input.sample.fresh = false;
  controller->tick(input);
  EXPECT_EQ(controller->tick(input).limit, Fault::kSampleStale) << "the gate lets go";
}

TEST_F(ControllerTest, ContactSeesNoPoseBeforeTheFirstSample) {
  input.sample.tool.position_m.z = -0.006;  // what a device may hold before it knows
  for (int i = 0; i < 30; ++i) EXPECT_EQ(controller->tick(input).limit, Fault::kNotArmed);
  EXPECT_FALSE(controller->is_inside());
  depth_m = -0.1;
  EXPECT_EQ(tick().contact_losses, 0u);
  EXPECT_EQ(tick().limit, Fault::kNotArmed);
}

TEST_F(ControllerTest, TwentyPeriodsSkippedAtOnceLatchInTheSameTick) {
  press();
  EXPECT_EQ(tick(19).fault, Fault::kNone);
  const TickOutput late = tick(20);
  EXPECT_EQ(late.written, model::Wrench{});
  EXPECT_EQ(late.fault, Fault::kLoopLate);
  EXPECT_EQ(tick().fault, Fault::kLoopLate) << "latched";
  EXPECT_EQ(tick().state, State::kStopped);
}

TEST_F(ControllerTest, TwentyLateTicksInARowLatch) {
  press();
  for (int i = 0; i < 19; ++i) EXPECT_EQ(tick(1).fault, Fault::kNone);
  tick();  // one in time
  for (int i = 0; i < 19; ++i) EXPECT_EQ(tick(1).fault, Fault::kNone);
  EXPECT_EQ(tick(1).fault, Fault::kLoopLate);
}

TEST_F(ControllerTest, WithoutHardRealTimeOnlyAHundredLateTicksInARowLatch) {
  use(false);
  press();
  EXPECT_EQ(tick(299).fault, Fault::kNone);
  EXPECT_EQ(tick().state, State::kArmed);
  for (int i = 0; i < 20; ++i) tick();
  EXPECT_GT(tick().written.force_N.z, 0.5) << "the tool has not moved: contact goes on";
  for (int i = 0; i < 99; ++i) EXPECT_EQ(tick(80).fault, Fault::kNone);
  const TickOutput late = tick(80);
  EXPECT_EQ(late.fault, Fault::kLoopLate);
  EXPECT_EQ(late.written, model::Wrench{});
}

TEST_F(ControllerTest, ALateLoopThatPushesNothingIsNoFault) {
  for (int i = 0; i < 50; ++i) EXPECT_EQ(tick(30).fault, Fault::kNone);
  EXPECT_EQ(tick().state, State::kReady);
}

TEST_F(ControllerTest, BladeOfALostToolCutsNothing) {
  press();
  const int cuts = law.cuts;
  depth_m = -0.1;
  ASSERT_EQ(tick().limit, Fault::kContactLost);
  EXPECT_EQ(law.cuts, cuts) << "on an unseen path";
  tick();
  EXPECT_EQ(law.cuts, cuts + 1);
}

TEST_F(ControllerTest, ABladeThatIsInsideWithoutAForceCutsNothing) {
  press();
  input.clutch = ClutchState::kOpen;
  tick();
  input.clutch = ClutchState::kCoupled;
  const int cuts = law.cuts;
  for (int i = 0; i < 10; ++i) ASSERT_EQ(tick().limit, Fault::kToolInside);
  EXPECT_EQ(law.cuts, cuts);
  for (; depth_m > -0.002; depth_m -= 5e-5) tick();
  EXPECT_GT(law.cuts, cuts) << "it was outside";
}

TEST_F(ControllerTest, ABladeCutsOnlyWhileArmed) {
  for (int i = 0; i < 10; ++i) tick();
  EXPECT_EQ(law.cuts, 0);
  press();
  const int armed_cuts = law.cuts;
  EXPECT_GT(armed_cuts, 100);
  input.device_fault = Fault::kDeviceFailed;
  tick();
  const int at_fault = law.cuts;
  for (int i = 0; i < 10; ++i) tick();
  EXPECT_EQ(law.cuts, at_fault) << "a stopped controller leaves the tissue alone";
}

}  // namespace tact::firmware::loop::controller_test
