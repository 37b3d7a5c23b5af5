// SPDX-License-Identifier: Apache-2.0
// The loop takes a tissue with other numbers while the tool is out of contact.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "firmware/loop/alloc_counter.h"
#include "model/scene/variant.h"
#include "tests/support/puppet_loop.h"

namespace tact::firmware::loop::offered_contact_test {

/// A tissue of other numbers, as an offer to the loop.
struct Made {
  Made(const model::scene::Scene& scene, std::uint32_t number, double ratio) {
    model::scene::Scene before = scene;
    const auto numbers = law_numbers(before);
    std::vector<std::string> set;
    for (const char* key :
         {"rhombus.normal_stiffness_N_per_m", "rhombus.tangential_stiffness_N_per_m"})
      set.push_back(fmt::format(
          "{}={}", key,
          ratio * std::ranges::find(numbers, key, &model::scene::LawNumber::key)->number.value()));
    variant = std::move(*make_variant(scene, set));
    offer = std::make_unique<OfferedContact>(
        OfferedContact{number, model::contact::Contact(variant.tissue->contact_scene())});
  }
  model::scene::Variant variant;
  std::unique_ptr<OfferedContact> offer;
};

using OfferedContactLoop = PuppetLoop;

TEST_F(OfferedContactLoop, IsTakenAfterTheToolHasLeftAndThenGivesAnotherForce) {
  press();
  const double before_N = device.last.force_N.z;
  const Made made(scene, 1, 1.5);
  loop.contacts().offer(*made.offer);
  run_ticks(100);
  EXPECT_EQ(device.last.force_N.z, before_N) << "not in contact";
  EXPECT_EQ(newest().input.variant, 0u);
  EXPECT_TRUE(loop.contacts().is_pending());

  for (; device.height_m < 0.006; device.height_m += 0.00005) loop.step();
  run_ticks(200);
  EXPECT_FALSE(loop.contacts().is_pending());
  EXPECT_EQ(newest().input.variant, 1u);
  for (; device.height_m > 0.001; device.height_m -= 0.00005) loop.step();
  run_ticks(10);
  EXPECT_GT(device.last.force_N.z, 1.2 * before_N);
}

// A tool that enters in the very tick of the change presses as if it had been there before.
TEST_F(OfferedContactLoop, InTheTickOfFirstContactLosesNoContact) {
  device.height_m = 0.00405;  // the sphere is 0.05 mm above the plate
  requests.arm_at_start.store(true);
  run_ticks(600);
  const Made made(scene, 1, 1.5);
  loop.contacts().offer(*made.offer);
  device.height_m = 0.0039;
  run_ticks(10);
  EXPECT_EQ(newest().input.variant, 1u);
  EXPECT_GT(device.last.force_N.z, 0.0);
  EXPECT_EQ(loop.statistics().inside_ticks, 0u);
  EXPECT_EQ(loop.statistics().contact_losses, 0u);
}

TEST_F(OfferedContactLoop, AThousandChangesStepNoForceAndAllocateNothing) {
  device.height_m = 0.006;
  requests.arm_at_start.store(true);
  run_ticks(600);
  const Made soft(scene, 1, 1.0), hard(scene, 2, 1.5);
  double phase = 0.0;
  std::uint32_t taken = 0;
  for (int i = 0; taken < 1000 && i < 10000; ++i) {
    loop.contacts().offer(*(i % 2 == 0 ? soft : hard).offer);
    // In contact for half of the time, at another phase at each change.
    for (int k = 0; k < 41; ++k, phase += 0.05) {
      device.height_m = 0.004 + 0.001 * std::sin(phase);
      const bool was_offered = loop.contacts().is_pending();
      const model::Wrench before = device.last;
      const HeapCallCounter heap;
      loop.step();
      EXPECT_EQ(heap.calls(), 0u);
      if (!was_offered || loop.contacts().is_pending()) continue;
      ++taken;
      EXPECT_EQ(before, model::Wrench{}) << i;
    }
    newest();  // empties the ring
  }
  EXPECT_EQ(taken, 1000u);
}

}  // namespace tact::firmware::loop::offered_contact_test
