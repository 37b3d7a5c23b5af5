// SPDX-License-Identifier: Apache-2.0
// A clutch parts tool and handle: no force meanwhile, and contact begins again after it.
#include "firmware/loop/clutch.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/puppet_loop.h"

namespace tact::firmware::loop::clutch_test {

hal::Sample at(double x_m) {
  hal::Sample sample;
  sample.tool.position_m = {x_m, 0.0, 0.0};
  sample.tool.velocity_mps = {1.0, 0.0, 0.0};
  sample.fresh = true;
  return sample;
}

TEST(Clutch, TheToolStaysWhileTheHandleMovesAndFollowsFromThere) {
  Clutch clutch;
  hal::Sample sample = at(0.01);
  EXPECT_EQ(clutch.step(false, false, sample), ClutchState::kCoupled);
  sample = at(0.02);
  EXPECT_EQ(clutch.step(true, /*has_force=*/true, sample), ClutchState::kYields);
  EXPECT_EQ(sample.tool.position_m, (model::Vec3{0.02, 0.0, 0.0})) << "it follows as before";
  for (const double x_m : {0.02, -0.03, -0.04}) {
    sample = at(x_m);
    EXPECT_EQ(clutch.step(true, false, sample), ClutchState::kOpen);
    EXPECT_NEAR(sample.tool.position_m.x, 0.02, 1e-15);
    EXPECT_EQ(sample.tool.velocity_mps.x, 1.0) << "the handle's, which the gate limits";
  }
  EXPECT_EQ(clutch.count(), 1u);
  sample = at(-0.04);
  EXPECT_EQ(clutch.step(false, false, sample), ClutchState::kCoupled);
  EXPECT_NEAR(sample.tool.position_m.x, 0.02, 1e-15) << "no jump";
  EXPECT_EQ(sample.tool.velocity_mps.x, 1.0);
  sample = at(-0.03);
  clutch.step(false, false, sample);
  EXPECT_NEAR(sample.tool.position_m.x, 0.03, 1e-15);
}

TEST(Clutch, ASampleThatIsNoNumberOrNotFreshLeavesTheShift) {
  Clutch clutch;
  hal::Sample sample = at(0.01);
  clutch.step(false, false, sample);
  sample = at(std::numeric_limits<double>::quiet_NaN());
  clutch.step(true, false, sample);
  EXPECT_TRUE(std::isnan(sample.tool.position_m.x)) << "it latches elsewhere";
  EXPECT_EQ(clutch.shift_m(), model::Vec3{});
  sample = at(0.05);
  sample.fresh = false;
  clutch.step(true, false, sample);
  EXPECT_EQ(sample.tool.position_m.x, 0.05) << "it is the tool of the last tick";
  EXPECT_EQ(clutch.shift_m(), model::Vec3{});
}

TEST(Clutch, PressedBeforeTheFirstSampleItWaitsForOne) {
  Clutch clutch;
  hal::Sample sample = at(0.01);
  EXPECT_EQ(clutch.step(true, false, sample), ClutchState::kYields);
  EXPECT_EQ(sample.tool.position_m.x, 0.01);
  sample = at(0.02);
  EXPECT_EQ(clutch.step(true, false, sample), ClutchState::kOpen);
  EXPECT_NEAR(sample.tool.position_m.x, 0.01, 1e-15);
}

class LoopClutch : public PuppetLoop {
 protected:
  LoopClutch() { lines.clutch_pressed = false; }
  double tool_m() { return tick_.input.sample.tool.position_m.z; }
  void tick() {
    run_ticks(1);
    tick_ = newest();
  }
  /// In contact; the force goes at its slew, and only then the tool stays.
  void open() {
    press();
    lines.clutch_pressed = true;
    double before_N = norm(device.last.force_N);
    ASSERT_GT(before_N, 0.05);
    int ticks = 0;
    for (tick(); tick_.input.clutch == ClutchState::kYields; tick(), ++ticks) {
      ASSERT_LE(norm(device.last.force_N), before_N);
      ASSERT_EQ(tick_.output.limit, Fault::kClutchPressed);
      ASSERT_LT(ticks, 1000);
      before_N = norm(device.last.force_N);
    }
    EXPECT_GT(ticks, 0);
    EXPECT_EQ(before_N, 0.0) << "zero before the tool stays";
    EXPECT_EQ(tick_.input.clutch, ClutchState::kOpen);
  }
  void move_handle_to(double height_m) {
    const double step_m = height_m < device.height_m ? -0.0005 : 0.0005;
    for (; std::abs(device.height_m - height_m) > 0.0006; device.height_m += step_m) tick();
    device.height_m = height_m;
    tick();
  }

 private:
  TickRecord tick_;

 protected:
  const TickRecord& last() const { return tick_; }
};

TEST_F(LoopClutch, NoForceWhileItIsOpenAndTheToolStays) {
  open();
  const double stays_m = tool_m();
  for (const double height_m : {0.02, -0.02, 0.0005}) {
    for (; std::abs(device.height_m - height_m) > 0.0004;
         device.height_m += height_m > device.height_m ? 0.0005 : -0.0005) {
      tick();
      ASSERT_EQ(device.last, model::Wrench{});
      ASSERT_NEAR(tool_m(), stays_m, 1e-12);
      ASSERT_EQ(last().output.limit, Fault::kClutchPressed);
      ASSERT_EQ(last().output.state, State::kArmed);
    }
  }
  EXPECT_EQ(loop.statistics().clutches, 1u);
  EXPECT_EQ(last().input.clutches, 1u);
}

TEST_F(LoopClutch, ReleasedInsideTheOrganThereIsNoForceUntilTheToolWasOutside) {
  open();
  const double depth_m = tool_m();
  move_handle_to(0.020);
  lines.clutch_pressed = false;
  for (int i = 0; i < 500; ++i) {
    tick();
    ASSERT_EQ(device.last, model::Wrench{}) << i;
  }
  EXPECT_EQ(last().output.limit, Fault::kToolInside);
  EXPECT_NEAR(tool_m(), depth_m, 1e-12);
  move_handle_to(0.030);  // the tool goes out, by as much
  EXPECT_NEAR(tool_m(), depth_m + 0.010, 1e-12);
  EXPECT_EQ(last().output.limit, Fault::kNone);
  move_handle_to(0.020);
  run_ticks(600);
  EXPECT_GT(device.last.force_N.z, 0.05) << "contact begins again, with the handle elsewhere";
}

TEST_F(LoopClutch, PressedForAMomentTheForceComesBackAndNothingIsReindexed) {
  press();
  const double force_N = device.last.force_N.z;
  lines.clutch_pressed = true;
  tick();
  EXPECT_LT(device.last.force_N.z, force_N);
  lines.clutch_pressed = false;
  run_ticks(600);
  tick();
  EXPECT_NEAR(device.last.force_N.z, force_N, 1e-6);
  EXPECT_EQ(loop.statistics().clutches, 0u);
  EXPECT_EQ(last().input.clutch_shift_m, model::Vec3{});
}

TEST_F(LoopClutch, TheWorkspaceIsThatOfTheHandle) {
  open();
  const double edge_m = scene.limits.workspace_radius_m;
  move_handle_to(edge_m - 0.01);
  lines.clutch_pressed = false;
  tick();
  EXPECT_NE(device.shift_m, model::Vec3{}) << "the simulated hand gets it";
  EXPECT_EQ(device.shift_m, last().input.clutch_shift_m);
  move_handle_to(edge_m + 0.02);
  run_ticks(100);
  tick();
  EXPECT_EQ(last().output.limit, Fault::kOutsideWorkspace);
  EXPECT_LT(tool_m(), edge_m) << "the tool is well inside";
}

}  // namespace tact::firmware::loop::clutch_test
