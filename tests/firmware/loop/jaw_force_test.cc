// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/jaw_force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "firmware/loop/rt_loop.h"
#include "hal/safety_lines.h"
#include "hal/sim/sim_delta.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"

namespace tact::firmware::loop::jaw_force_test {

using model::contact::SphereTouch;

SphereTouch jaw(double normal_N, double side = 1.0) {
  const model::Vec3 normal{0.0, side, 0.0};
  SphereTouch touch;
  touch.normal = normal;
  touch.force_N = normal_N * normal + model::Vec3{0.0, 0.0, 0.7};
  return touch;
}

TEST(JawForce, IsTheMeanOfBothNormalForcesTimesHowFarTheyAreClosed) {
  const std::array jaws{jaw(0.6, 1.0), jaw(1.0, -1.0)};
  EXPECT_DOUBLE_EQ(jaw_force_N(jaws, 1.0), 0.8);
  EXPECT_DOUBLE_EQ(jaw_force_N(jaws, 0.5), 0.4);
  EXPECT_DOUBLE_EQ(jaw_force_N(jaws, 7.0), 0.8);
}

TEST(JawForce, OpenJawsHaveNone) {
  const std::array jaws{jaw(0.6), jaw(1.0)};
  EXPECT_EQ(jaw_force_N(jaws, 0.0), 0.0);
}

TEST(JawForce, TissueThatIsPulledClosesNoFingers) {
  const std::array jaws{jaw(-0.6), jaw(-1.0)};
  EXPECT_EQ(jaw_force_N(jaws, 1.0), 0.0);
}

TEST(JawForce, AToolWithoutTwoSpheresHasNoJaws) {
  const std::array one{jaw(1.0)};
  const std::array three{jaw(1.0), jaw(1.0), jaw(1.0)};
  EXPECT_EQ(jaw_force_N(one, 1.0), 0.0);
  EXPECT_EQ(jaw_force_N(three, 1.0), 0.0);
}

TEST(JawForce, AForceThatIsNoNumberStaysOne) {
  const std::array jaws{jaw(1.0), jaw(std::nan(""))};
  EXPECT_TRUE(std::isnan(jaw_force_N(jaws, 1.0)));
}

/// The liver, pressed and gripped by the simulated hand, with a gripper that presses.
TEST(JawForce, ReachesTheFingersOfTheLiversForcepsThroughItsGate) {
  const auto scene = model::scene::load_scene(TACT_SOURCE_DIR "/model/scenes/liver.toml", {});
  ASSERT_TRUE(scene) << scene.error().sentence;
  const auto tissue = std::move(*model::scene::make_tissue(*scene));
  const double period_s = 1.0 / scene->rate_Hz;
  hal::sim::SimDelta device(scene->device.sim, scene->hand);
  hal::NoSafetyLines lines;
  Controller controller(tissue->contact_scene(), gate::Gate(scene->limits, period_s, 1.0), true,
                        gate::GripGate::make(scene->limits, period_s, 1.0));
  SimulatedClock clock;
  Requests requests;
  const auto ring = std::make_unique<TickRing>();
  RtLoop loop({.period_ns = 1'000'000}, device, lines, controller, clock, requests, *ring);
  requests.arm_at_start.store(true);
  double most_N = 0.0;
  int open_with_force = 0;
  for (int i = 0; i < 12'000; ++i) {
    loop.step();
    TickRecord record;
    while (ring->pop(record)) {
      ASSERT_EQ(record.output.fault, Fault::kNone) << i;
      most_N = std::max(most_N, device.grip_force_N());
      if (record.input.sample.tool.grip_ratio == 0.0 && record.output.wanted_grip_N != 0.0)
        ++open_with_force;
    }
  }
  EXPECT_GT(most_N, 0.05);
  EXPECT_LT(most_N, 1.0);
  EXPECT_EQ(most_N, loop.statistics().max_grip_force_N);
  EXPECT_EQ(open_with_force, 0);
  loop.release_device();
  EXPECT_EQ(device.grip_force_N(), 0.0);
}

}  // namespace tact::firmware::loop::jaw_force_test
