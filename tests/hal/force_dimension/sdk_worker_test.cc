// SPDX-License-Identifier: Apache-2.0
#include "hal/force_dimension/sdk_worker.h"

#include <gtest/gtest.h>

namespace tact::hal::force_dimension::sdk_worker_test {

TEST(SdkWorker, HasAPoseAndAForceForEveryTickOfAFastLoop) {
  for (const double rate_Hz : {100.0, 1000.0, 4000.0}) EXPECT_EQ(sdk_cycle_ns(rate_Hz), 250'000);
  EXPECT_EQ(sdk_cycle_ns(8000.0), 125'000);
  EXPECT_EQ(sdk_cycle_ns(10'000.0), 100'000);
}

}  // namespace tact::hal::force_dimension::sdk_worker_test
