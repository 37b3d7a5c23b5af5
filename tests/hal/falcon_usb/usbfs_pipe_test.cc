// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/usbfs_pipe.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <vector>

#include "tests/hal/falcon_usb/usbfs_bus.h"

namespace tact::tests::usbfs_pipe_test {

TEST(UsbfsPipe, ReportsArriveStampedAndTheTransfersStayUnderWay) {
  Bus bus;
  const auto pipe = start(bus);
  for (std::uint64_t i = 1; i <= 20; ++i) {
    const std::int64_t before_ns = monotonic_ns();
    bus.send(transfer_of({.counts = {static_cast<int>(i), -5, 6}, .homed = 7}));
    const falcon::FalconReply reply = wait_for_reply(*pipe, i);
    EXPECT_EQ(reply.sequence, i);
    EXPECT_EQ(reply.report.counts[0], static_cast<int>(i));
    EXPECT_GE(reply.stamp_ns, before_ns);
    EXPECT_LE(reply.stamp_ns, monotonic_ns());
  }
  EXPECT_TRUE(bus.wait_for([&] { return bus.in.size() == falcon_usb::UsbfsPipe::kIn; }));
}

TEST(UsbfsPipe, TheNewestOfSeveralReportsWinsAndAllAreCounted) {
  Bus bus;
  const auto pipe = start(bus);
  std::vector<std::uint8_t> both = transfer_of({.counts = {1, 1, 1}});
  const falcon::FalconPacket second = encode(falcon::FalconReport{.counts = {2, 2, 2}});
  both.insert(both.end(), second.begin(), second.end());
  bus.send(both);
  const falcon::FalconReply reply = wait_for_reply(*pipe, 2);
  EXPECT_EQ(reply.sequence, 2u);
  EXPECT_EQ(reply.report.counts[0], 2);
}

TEST(UsbfsPipe, CommandsLeaveUnchangedAndInOrder) {
  Bus bus;
  const auto pipe = start(bus);
  const std::int64_t before_ns = monotonic_ns();
  for (int i = 0; i < 50; ++i) {
    const falcon::FalconPacket packet = encode(falcon::FalconCommand{.motor = {i, -i, 7}});
    for (int tries = 0; !pipe->submit(packet) && tries < 1000; ++tries)
      falcon_usb::usb_pause_ns(100'000);
  }
  ASSERT_TRUE(bus.wait_for([&] { return Bus::of_loop(bus.taken).size() == 50; }));
  const std::vector<falcon::FalconPacket> taken = bus.taken_now();
  if (monotonic_ns() - before_ns < kLoopGone_ns) EXPECT_EQ(taken.size(), 50u);
  for (int i = 0; i < 50; ++i)
    EXPECT_EQ(Bus::of_loop(taken)[static_cast<std::size_t>(i)],
              encode(falcon::FalconCommand{.motor = {i, -i, 7}}));
}

TEST(UsbfsPipe, NeverMoreThanTwoCommandsAreUnderWay) {
  Bus bus;
  bus.swallow_out = true;
  const auto pipe = start(bus);
  EXPECT_TRUE(pipe->submit(last_command));
  EXPECT_TRUE(pipe->submit(last_command));
  EXPECT_FALSE(pipe->submit(last_command));
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kOpen);  // a missed cycle
  bus.change([&] { bus.finish(bus.out, 0, 16); });
  bool taken = false;
  for (int i = 0; i < 1000 && !taken; ++i, falcon_usb::usb_pause_ns(1'000'000))
    taken = pipe->submit(last_command);
  EXPECT_TRUE(taken);
}

TEST(UsbfsPipe, StoppingSendsTheLastCommandEndsTheThreadAndClosesTheNode) {
  Bus bus;
  auto pipe = start(bus);
  pipe->stop(last_command);
  pipe->stop(last_command);
  ASSERT_EQ(bus.commands.size(), 1u);
  EXPECT_EQ(bus.commands[0], last_command);
  EXPECT_TRUE(bus.closed);
  EXPECT_TRUE(bus.in.empty());
  EXPECT_TRUE(thread_of(*pipe).ended());
  EXPECT_EQ(thread_of(*pipe).last_policy(), SCHED_OTHER);
}

TEST(UsbfsPipe, StoppingDoesNotWaitForADeviceThatTakesNothing) {
  Bus bus;
  bus.swallow_out = true;
  auto pipe = start(bus);
  pipe->submit(last_command);
  pipe->submit(last_command);
  const std::int64_t before_ns = monotonic_ns();
  pipe->stop(last_command);
  EXPECT_LT(monotonic_ns() - before_ns, 1'000'000'000);
  EXPECT_TRUE(bus.closed);
}

TEST(UsbfsPipe, ALoopThatFallsSilentIsReplacedByZerosWhichIsReported) {
  Bus bus;
  const auto pipe = start(bus);
  const falcon::FalconPacket push = encode(falcon::FalconCommand{.motor = {900, 900, 900}});
  const std::int64_t before_ns = monotonic_ns();
  EXPECT_TRUE(pipe->submit(push));
  EXPECT_FALSE(pipe->health().stood_in);
  while (bus.taken_now().size() < 2 && monotonic_ns() - before_ns < 5'000'000'000) {
    bus.send({0x01, 0x60});  // the adapter's latency timer
    falcon_usb::usb_pause_ns(1'000'000);
  }
  EXPECT_GE(monotonic_ns() - before_ns, kLoopGone_ns);
  const std::vector<falcon::FalconPacket> taken = bus.taken_now();
  ASSERT_GE(taken.size(), 2u);
  if (monotonic_ns() - before_ns < 2 * kLoopGone_ns) EXPECT_EQ(taken.size(), 2u);
  EXPECT_EQ(taken[1], falcon_usb::LoopSilence::zero());
  EXPECT_TRUE(pipe->health().stood_in);
  EXPECT_TRUE(pipe->submit(push));
  EXPECT_TRUE(bus.wait_for([&] { return Bus::of_loop(bus.taken) == std::vector{push, push}; }));
}

TEST(UsbfsPipe, ZerosNeedNoTransferOfTheLoops) {
  Bus bus;
  bus.swallow_out = true;
  const auto pipe = start(bus);
  for (std::size_t i = 0; i < falcon_usb::UsbfsPipe::kOut; ++i)
    EXPECT_TRUE(pipe->submit(zero_command));
  for (int i = 0; i < 3000 && bus.wait_for([&] { return true; }); ++i) {
    bus.send({0x01, 0x60});
    falcon_usb::usb_pause_ns(1'000'000);
    const std::lock_guard lock(bus.mutex);
    if (bus.commands.size() > falcon_usb::UsbfsPipe::kOut) break;
  }
  const std::lock_guard lock(bus.mutex);
  ASSERT_EQ(bus.commands.size(), falcon_usb::UsbfsPipe::kOut + 1);
  EXPECT_EQ(bus.commands.back(), falcon_usb::LoopSilence::zero());
}

}  // namespace tact::tests::usbfs_pipe_test
