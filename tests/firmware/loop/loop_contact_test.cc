// SPDX-License-Identifier: Apache-2.0
// Contact in the loop: arming, a tool that is found inside the organ, a tool that jumps.
#include <gtest/gtest.h>

#include "firmware/loop/rt_loop.h"
#include "tests/support/puppet_loop.h"

namespace tact::firmware::loop::loop_contact_test {

using LoopContact = PuppetLoop;

TEST_F(LoopContact, ArmedWhilePressingTheForceRampsUp) {
  device.height_m = 0.006;
  run_ticks(5);
  for (; device.height_m > 0.001; device.height_m -= 0.0001) loop.step();
  requests.arm_at_start.store(true);
  run_ticks(2);
  EXPECT_EQ(newest().output.state, State::kArmed);
  const double force_N = tissue->law().curve()->respond(0.004 - device.height_m).force_N;
  EXPECT_LT(norm(device.last.force_N), 0.02 * force_N);
  run_ticks(1000);
  EXPECT_NEAR(device.last.force_N.z, force_N, 1e-6);
}

TEST_F(LoopContact, AToolFoundInsideTheOrganHasNoForceAndIsCounted) {
  device.height_m = -0.006;
  requests.arm_at_start.store(true);
  run_ticks(1000);
  const TickRecord inside = newest();
  EXPECT_EQ(inside.output.state, State::kArmed);
  EXPECT_EQ(inside.output.limit, Fault::kToolInside);
  EXPECT_EQ(device.last, model::Wrench{});
  EXPECT_EQ(loop.statistics().inside_ticks, loop.statistics().ticks);
  for (; device.height_m < 0.006; device.height_m += 0.0001) loop.step();
  for (; device.height_m > 0.001; device.height_m -= 0.0001) loop.step();
  EXPECT_GT(device.last.force_N.z, 0.05) << "it was outside once";
  EXPECT_LT(loop.statistics().inside_ticks, loop.statistics().ticks);
  EXPECT_EQ(loop.statistics().contact_losses, 0u);
}

// A device that is real has a sample of then; what was skipped is passed to the tick after it.
TEST_F(LoopContact, AToolThatMovesWhileTheLoopWakesLateKeepsItsContact) {
  device.height_m = 0.006;
  requests.arm_at_start.store(true);
  run_ticks(600);
  for (; device.height_m > 0.002; device.height_m -= 0.00005) loop.step();
  tests::pass_ns(clock, 20'000'000);
  device.height_m -= 0.002;  // 0.1 m/s for 20 ms: more than 1.5 m/s for one
  run_ticks(2);
  EXPECT_EQ(loop.statistics().skipped_ticks, 19u);
  EXPECT_EQ(loop.statistics().contact_losses, 0u);
  EXPECT_GT(device.last.force_N.z, 0.15);
}

TEST_F(LoopContact, ContactLossesAreCounted) {
  press();
  device.height_m = 0.030;
  run_ticks(2);
  EXPECT_EQ(newest().output.contact_losses, 1u);
  EXPECT_EQ(loop.statistics().contact_losses, 1u);
}

}  // namespace tact::firmware::loop::loop_contact_test
