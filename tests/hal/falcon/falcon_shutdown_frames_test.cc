// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hal/falcon/falcon_boot.h"
#include "tests/hal/falcon/falcon_bench.h"

namespace tact::tests::falcon_shutdown_frames_test {

TEST(FalconShutdownFrames, AreZeroCurrentOverTheOpenDescriptor) {
  FalconBench bench;
  bench.pipe->fd = 42;
  bench.home();
  bench.run(3, {0.0, 0.0, 4.0});
  ASSERT_NE(bench.words(), falcon::FalconWords{});
  const auto frames = bench.device.shutdown_frames();
  ASSERT_TRUE(frames);
  EXPECT_EQ(frames->fd, 42);
  EXPECT_EQ(frames->carrier, ShutdownFrames::Carrier::kUsbBulk);
  EXPECT_EQ(frames->endpoint, falcon::kFalconEndpointOut);
  ASSERT_GE(frames->count, 2u) << "the arrival of one is not reported";
  for (std::size_t i = 0; i < frames->count; ++i) {
    const auto command = falcon::decode_falcon_command(frames->bytes_of(i));
    ASSERT_TRUE(command);
    EXPECT_EQ(command->motor, falcon::FalconWords{});
    EXPECT_EQ(command->lights, falcon::kFalconRed);
  }
}

TEST(FalconShutdownFrames, NoFramesWithoutADescriptor) {
  FalconBench bench;
  EXPECT_FALSE(bench.device.shutdown_frames());
}

}  // namespace tact::tests::falcon_shutdown_frames_test
