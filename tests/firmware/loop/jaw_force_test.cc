// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/jaw_force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "firmware/loop/rt_loop.h"
#include "hal/registry/open_device.h"
#include "hal/safety_lines.h"
#include "hal/sim/sim_delta.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"

namespace tact::firmware::loop::jaw_force_test {

using model::contact::SphereContact;

SphereContact jaw(double normal_N, double side = 1.0) {
  const model::Vec3 normal{0.0, side, 0.0};
  SphereContact sphere_contact;
  sphere_contact.normal = normal;
  sphere_contact.force_N = normal_N * normal + model::Vec3{0.0, 0.0, 0.7};
  return sphere_contact;
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

TEST(JawForce, NanForceStaysNan) {
  const std::array jaws{jaw(1.0), jaw(std::nan(""))};
  EXPECT_TRUE(std::isnan(jaw_force_N(jaws, 1.0)));
}

/// The liver, pressed and gripped by the simulated hand, on a gripper that presses.
class LiverJaws : public testing::Test {
 protected:
  /// Ticks through the script as far as its pull.
  void play(bool armed) {
    requests_.arm_at_start.store(armed);
    for (int i = 0; i < 12'000; ++i) {
      loop_.step();
      TickRecord record;
      while (ring_->pop(record)) {
        ASSERT_EQ(record.output.fault, Fault::kNone) << i;
        most_N_ = std::max(most_N_, device_.grip_force_N());
        most_wanted_N_ = std::max(most_wanted_N_, record.output.wanted_grip_N);
        if (record.input.sample.tool.grip_ratio == 0.0 && record.output.wanted_grip_N != 0.0)
          ++open_with_force_;
      }
    }
  }

  const model::scene::Scene scene_ =
      std::move(*hal::registry::load_scene(TACT_SOURCE_DIR "/model/scenes/liver.toml", {}));
  std::unique_ptr<model::scene::Tissue> tissue_ = std::move(*model::scene::make_tissue(scene_));
  hal::sim::SimDelta device_{scene_.device.of<hal::sim::SimDeviceSettings>(), scene_.hand};
  hal::NoSafetyLines lines_;
  Controller controller_{tissue_->contact_scene(), gate::Gate(scene_.limits, 0.001, 1.0), true,
                         gate::GripGate::make(scene_.limits, 0.001, 1.0)};
  SimulatedClock clock_;
  Requests requests_;
  std::unique_ptr<TickRing> ring_ = std::make_unique<TickRing>();
  RtLoop loop_{{.period_ns = 1'000'000}, device_, lines_, controller_, clock_, requests_, *ring_};
  double most_N_ = 0.0, most_wanted_N_ = 0.0;
  int open_with_force_ = 0;
};

TEST_F(LiverJaws, PressTheFingersThroughTheirGate) {
  play(true);
  EXPECT_GT(most_N_, 0.05);
  EXPECT_LT(most_N_, 1.0);
  EXPECT_EQ(most_N_, loop_.statistics().max_grip_force_N);
  EXPECT_EQ(open_with_force_, 0);
  loop_.release_device();
  EXPECT_EQ(device_.grip_force_N(), 0.0);
}

TEST_F(LiverJaws, PressNoFingersBeforeArming) {
  play(false);
  EXPECT_GT(most_wanted_N_, 0.05) << "the tissue is gripped all the same";
  EXPECT_EQ(most_N_, 0.0);
}

}  // namespace tact::firmware::loop::jaw_force_test
