// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hal/falcon_usb/usbfs_pipe.h"

namespace tact::hal::falcon_usb::loop_silence_test {

constexpr std::int64_t kMs = 1'000'000;

TEST(LoopSilence, ALoopThatSendsIsNeverReplaced) {
  LoopSilence silence;
  for (std::int64_t i = 1; i <= 1000; ++i)
    EXPECT_FALSE(silence.is_due(static_cast<std::uint64_t>(i), 99 * kMs * i));
}

TEST(LoopSilence, IsDueAfterAHundredMillisecondsAndAgainAfterAsMany) {
  LoopSilence silence;
  EXPECT_FALSE(silence.is_due(7, 1000 * kMs));
  for (std::int64_t ms = 1001; ms < 1400; ++ms)
    EXPECT_EQ(silence.is_due(7, ms * kMs), ms % 100 == 0) << ms;
  EXPECT_FALSE(silence.is_due(8, 1400 * kMs)) << "heard again";
  EXPECT_FALSE(silence.is_due(8, 1499 * kMs));
  EXPECT_TRUE(silence.is_due(8, 1500 * kMs));
}

TEST(LoopSilence, BeforeTheFirstCommandThereIsNothingToEnd) {
  LoopSilence silence;
  EXPECT_FALSE(silence.is_due(0, 1000 * kMs));
  EXPECT_FALSE(silence.is_due(0, 9000 * kMs));
}

TEST(LoopSilence, SendsNoForce) {
  const auto command = falcon::decode_falcon_command(LoopSilence::zero());
  ASSERT_TRUE(command);
  EXPECT_EQ(command->motor, falcon::FalconWords{});
}

}  // namespace tact::hal::falcon_usb::loop_silence_test
