// SPDX-License-Identifier: Apache-2.0
// The laws with memory that the stability maps probe are what the maps say of them.
#include "tools/stability/laws/memory_laws.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tools/stability/laws/laws.h"
#include "tools/stability/loop/haptic_loop.h"

namespace tact::tools::stability::memory_laws_test {

const NamedLaw& law_named(const std::string& name) {
  const auto& laws = probed_laws();
  return *std::find_if(laws.begin(), laws.end(), [&](const NamedLaw& n) { return n.name == name; });
}

TEST(MemoryLaws, EveryLawOfTheMapsIsMade) {
  EXPECT_EQ(probed_laws().size(), 15u);
  EXPECT_EQ(std::count_if(probed_laws().begin(), probed_laws().end(),
                          [](const NamedLaw& n) { return n.remembers(); }),
            3);
}

TEST(MemoryLaws, EachRunMeetsAFreshTissue) {
  for (const NamedLaw& named : probed_laws()) {
    RenderedTissue first = named.fresh();
    for (int i = 0; i < 50; ++i) first.tick(0.5 * named.rendered_range_m);
    RenderedTissue second = named.fresh(), third = named.fresh();
    for (int i = 0; i < 50; ++i)
      EXPECT_EQ(second.tick(1e-5 * i).force_N, third.tick(1e-5 * i).force_N) << named.name;
  }
}

TEST(MemoryLaws, ARelaxingLawSettlesAtTheHalfThatStays) {
  const double elastic_N = law_named("compliance").fresh().settle(0.004).force_N;
  RenderedTissue relaxing = law_named("compliance relaxing").fresh();
  // new, all of it resists, but for what fades in the first tick
  EXPECT_NEAR(relaxing.tick(0.004).force_N / elastic_N, 1.0, 0.03);
  EXPECT_NEAR(relaxing.settle(0.004).force_N / elastic_N, 0.5, 1e-6);
}

TEST(MemoryLaws, ASpringPatchThatRelaxesSettlesSofter) {
  const double elastic_N = law_named("spring patch").fresh().settle(0.004).force_N;
  const double relaxed_N = law_named("spring patch relaxing").fresh().settle(0.004).force_N;
  EXPECT_LT(relaxed_N, 0.75 * elastic_N);
  EXPECT_GT(relaxed_N, 0.4 * elastic_N);
}

// A tissue that still sank from the run before would fall away from its balance.
TEST(MemoryLaws, TheLargestFactorAsksForANewTissueEachRun) {
  LoopCase loop;
  loop.device.damping_Ns_per_m = 1.0;
  loop.duration_s = 0.2;
  int made = 0;
  const TissueMaker fresh = [&made] {
    ++made;
    return TissueForce([](double depth_m) { return depth_m; });
  };
  const double largest = largest_factor(loop, fresh, Verdict::kGrow, 100.0, 1e5);
  EXPECT_NEAR(largest / 2000.0, 1.0, 0.05);  // 2 b / T
  EXPECT_GT(made, 5);
}

}  // namespace tact::tools::stability::memory_laws_test
