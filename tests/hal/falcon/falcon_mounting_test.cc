// SPDX-License-Identifier: Apache-2.0
// A hanging or an upright Falcon compensates its own weight along gravity.
#include <gtest/gtest.h>

#include "hal/falcon/falcon_device.h"
#include "hal/mounting.h"
#include "tests/hal/falcon/falcon_bench.h"
#include "tests/support/mountings.h"

namespace tact::tests::falcon_mounting_test {

TEST(FalconMounting, HoldsItsOwnWeightInSixMountings) {
  hal::falcon::FalconSettings settings = falcon_settings();
  settings.moving_mass_kg = 0.1;
  for (const auto& one : kMountings) {
    FalconBench bench(settings);
    bench.device.set_gravity(mounting_of(settings_of(one)).gravity_in_base_mps2());
    bench.home({0.01, 0.0, 0.0});
    bench.run(60);
    const Vec3 rendered_N = force_of(bench.words(), settings, {0.01, 0.0, 0.0});
    EXPECT_LT(norm(rendered_N + 0.981 * one.down_B), 0.01) << one.words;
  }
}

}  // namespace tact::tests::falcon_mounting_test
