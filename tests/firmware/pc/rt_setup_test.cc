// SPDX-License-Identifier: Apache-2.0
#include "firmware/pc/rt_setup.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <thread>

namespace tact::firmware::pc::rt_setup_test {

struct Denormals {
  double made = 0.0;  // half of the least normal number
  double read = 0.0;  // the least denormal, times what makes it normal again
};

// In a thread of its own, whose flags end with it; volatile, so that the processor does it.
Denormals denormals_after(const std::function<void()>& setup) {
  Denormals found;
  std::thread([&] {
    setup();
    volatile double least_normal = std::numeric_limits<double>::min();
    volatile double least = std::numeric_limits<double>::denorm_min();
    volatile double made = least_normal * 0.5, read = least * 0x1p200;
    found = {made, read};
  }).join();
  return found;
}

TEST(RtSetup, DenormalsAreZeroOnceTheyAreFlushed) {
  const Denormals kept = denormals_after([] {});
  EXPECT_GT(kept.made, 0.0) << "else this test is blind";
  EXPECT_GT(kept.read, 0.0);
  const Denormals flushed = denormals_after(flush_denormals);
  EXPECT_EQ(flushed.made, 0.0);
  EXPECT_EQ(flushed.read, 0.0);
}

TEST(RtSetup, TheLoopsThreadFlushesThem) {
  const Denormals flushed = denormals_after([] {
    std::vector<Shortfall> shortfalls;
    enter_rt_thread({}, shortfalls);
  });
  EXPECT_EQ(flushed.made, 0.0);
  EXPECT_EQ(flushed.read, 0.0);
}

}  // namespace tact::firmware::pc::rt_setup_test
