// SPDX-License-Identifier: Apache-2.0
#include "firmware/embed/haptics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "firmware/loop/alloc_counter.h"
#include "model/scene/tissue.h"
#include "tests/support/message.h"

namespace tact::haptics_test {

using firmware::loop::State;
using firmware::loop::TickOutput;

const std::string kLiver = std::string(TACT_SOURCE_DIR) + "/model/scenes/liver.toml";

/// A tool that goes in and out of the organ every half second, from outside.
class Samples {
 public:
  explicit Samples(const model::scene::Scene& scene) : scene_(scene) {}
  const hal::Sample& next() {
    const double time_s = static_cast<double>(sample_.sequence) / scene_.rate_Hz;
    sample_.tool.position_m =
        scene_.hand_site_m - (0.008 * std::cos(12.566 * time_s)) * scene_.hand_inward;
    sample_.stamp_ns = static_cast<std::int64_t>(1e9 * time_s);
    ++sample_.sequence;
    sample_.fresh = true;
    return sample_;
  }

 private:
  const model::scene::Scene& scene_;
  hal::Sample sample_;
};

std::unique_ptr<Haptics> liver(const HapticsSettings& settings = {}) {
  auto made = Haptics::make(kLiver, settings);
  EXPECT_TRUE(made) << tests::message_of(made);
  return std::move(*made);
}

TEST(Haptics, GivesTheForcesOfTheControllerBitForBitAndAllocatesNothing) {
  const auto haptics = liver();
  const model::scene::Scene scene = *model::scene::load_scene(kLiver, {});
  const auto tissue = std::move(*make_tissue(scene));
  firmware::loop::Controller controller(
      tissue->contact_scene(),
      firmware::gate::Gate(scene.limits, 1.0 / scene.rate_Hz, firmware::gate::kNonRtForceShare),
      false);
  Samples samples(scene);
  firmware::loop::TickInput input;
  double largest_N = 0.0;
  for (int tick = 0; tick < 2000; ++tick) {
    input.sample = samples.next();
    if (tick == 10) haptics->arm();
    input.commands.arm = tick == 10;
    const TickOutput expected = controller.tick(input);
    const firmware::loop::HeapCallCounter heap;
    const TickOutput out = haptics->tick(input.sample);
    ASSERT_EQ(heap.calls(), 0u);
    ASSERT_EQ(out.written, expected.written) << tick;
    ASSERT_EQ(out.wanted, expected.wanted) << tick;
    ASSERT_EQ(out.state, expected.state) << tick;
    largest_N = std::max(largest_N, norm(out.written.force_N));
  }
  EXPECT_GT(largest_N, 0.05);
  EXPECT_LE(largest_N, haptics->force_limit_N());
}

TEST(Haptics, ArmsDisarmsAndResetsInTheNextTick) {
  const auto haptics = liver();
  Samples samples(haptics->scene());
  EXPECT_EQ(haptics->tick(samples.next()).state, State::kReady);
  haptics->arm();
  EXPECT_EQ(haptics->tick(samples.next()).state, State::kArmed);
  haptics->disarm();
  EXPECT_EQ(haptics->tick(samples.next()).state, State::kReady);
  EXPECT_EQ(haptics->tick(samples.next(), 0, model::Fault::kDeviceLost).state, State::kStopped);
  haptics->arm();
  EXPECT_EQ(haptics->tick(samples.next()).state, State::kStopped) << "not without reset";
  haptics->reset();
  EXPECT_EQ(haptics->tick(samples.next()).state, State::kReady);
}

TEST(Haptics, UsesNumbersAsSoonAsTheToolIsOutOfContact) {
  const auto haptics = liver();
  Samples samples(haptics->scene());
  double before_N = 0.0, after_N = 0.0;
  for (int tick = 0; tick < 500; ++tick)
    before_N = std::max(before_N, norm(haptics->tick(samples.next()).wanted.force_N));
  for (int tick = 0; tick < 200; ++tick) haptics->tick(samples.next());
  ASSERT_GT(norm(haptics->contacts()[0].force_N), 0.0);
  EXPECT_EQ(tests::message_of(haptics->set({"elastic.youngs_modulus_Pa=3000"})), "");
  EXPECT_EQ(tests::message_of(haptics->set({"elastic.youngs_modulus_Pa=2500"})), "");
  haptics->tick(samples.next());
  EXPECT_FALSE(haptics->is_set()) << "in contact";
  for (int tick = 0; tick < 300; ++tick) haptics->tick(samples.next());
  EXPECT_TRUE(haptics->is_set());
  for (int tick = 0; tick < 500; ++tick)
    after_N = std::max(after_N, norm(haptics->tick(samples.next()).wanted.force_N));
  EXPECT_GT(after_N, 0.0);
  EXPECT_LT(after_N, 0.95 * before_N);
  EXPECT_NE(tests::message_of(haptics->set({"limits.force_N=3"})).find("cannot change"),
            std::string::npos);
}

TEST(Haptics, KeepsTheSmallerLimitsOfSceneAndDevice) {
  hal::DeviceInfo weak{.name = "weak", .max_force_N = 0.8, .grip = hal::GripKind::kNone};
  weak.workspace_radius_m = weak.workspace_half_length_m = 0.1;
  EXPECT_DOUBLE_EQ(liver({.device = weak, .hard_real_time = true})->force_limit_N(), 0.8);
  EXPECT_DOUBLE_EQ(liver({.device = weak})->force_limit_N(), 0.2);
  EXPECT_NE(tests::message_of(Haptics::make("/nowhere.toml")).find("/nowhere.toml"),
            std::string::npos);
}

}  // namespace tact::haptics_test
