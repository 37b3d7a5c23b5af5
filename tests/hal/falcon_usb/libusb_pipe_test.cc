// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/libusb_pipe.h"

#include <gtest/gtest.h>
#include <sched.h>

#include "hal/monotonic.h"
#include "tests/hal/falcon_usb/libusb_pipe_fixture.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::falcon_usb::libusb_pipe_test {

const falcon::FalconPacket zero_command = encode(falcon::FalconCommand{});
const falcon::FalconPacket last_command =
    encode(falcon::FalconCommand{.lights = falcon::kFalconRed});

TEST_F(LibusbPipeTest, ReportsArriveStampedAndFourTransfersStayUnderWay) {
  for (std::uint64_t i = 1; i <= 20; ++i) {
    const std::int64_t before_ns = monotonic_ns();
    send(transfer_of({.counts = {static_cast<int>(i), 2, 3}}));
    falcon::FalconReply reply;
    ASSERT_TRUE(wait_for([&] { return pipe->newest(reply); }));
    EXPECT_EQ(reply.sequence, i);
    EXPECT_EQ(reply.report.counts[0], static_cast<int>(i));
    EXPECT_GE(reply.stamp_ns, before_ns);
  }
  EXPECT_TRUE(wait_for([&] { return locked([&] { return usb.in.size() == LibusbPipe::kIn; }); }));
}

TEST_F(LibusbPipeTest, TheLoopsSideOfACommandLeavesTheHeapAlone) {
  const falcon::FalconPacket packet = encode(falcon::FalconCommand{.motor = {7, -8, 9}});
  std::uint64_t calls = 1;
  {
    const tests::NoAlloc guard;
    EXPECT_TRUE(pipe->submit(packet));
    calls = guard.calls();
  }
  EXPECT_EQ(calls, 0u);
  ASSERT_TRUE(wait_for([&] { return locked([&] { return !usb.commands.empty(); }); }));
  EXPECT_EQ(locked([&] { return usb.commands[0]; }), bytes_of(packet));
}

TEST_F(LibusbPipeTest, ALoopThatFallsSilentIsReplacedByZerosWhichIsTold) {
  const falcon::FalconPacket push = encode(falcon::FalconCommand{.motor = {900, 900, 900}});
  EXPECT_FALSE(pipe->health().stood_in);
  for (const bool answers : {true, false}) {  // the adapter's latency timer, or nothing at all
    pipe.reset();
    open();
    locked([&] { usb.taken.clear(); });
    const std::int64_t before_ns = monotonic_ns();
    EXPECT_TRUE(pipe->submit(push));
    EXPECT_TRUE(wait_for([&] {
      if (answers) send({0x01, 0x60});
      return locked([&] { return usb.taken.size() >= 2; });
    }));
    EXPECT_GE(monotonic_ns() - before_ns, kLoopGone_ns);
    const std::vector<tests::Bytes> taken = locked([&] { return usb.taken; });
    ASSERT_GE(taken.size(), 2u);
    if (monotonic_ns() - before_ns < 2 * kLoopGone_ns) EXPECT_EQ(taken.size(), 2u);
    EXPECT_EQ(taken[0], bytes_of(push));
    EXPECT_EQ(taken[1], bytes_of(LoopSilence::zero()));
    EXPECT_TRUE(pipe->health().stood_in);
  }
}

TEST_F(LibusbPipeTest, SilenceIsCountedFromTheCommandAndNotFromTheReplyBefore) {
  for (int i = 0; i < 10; ++i, pipe.reset(), open()) {
    locked([&] { usb.taken.clear(); });
    const std::int64_t before_ns = monotonic_ns();
    EXPECT_TRUE(pipe->submit(numbered(900)));
    EXPECT_TRUE(wait_for([&] { return locked([&] { return !usb.taken.empty(); }); }));
    for (int k = 0; k < 5; ++k) {  // the first replies ever, some milliseconds later
      send({0x01, 0x60});
      usb_pause_ns(2'000'000);
    }
    const bool stood_in = pipe->health().stood_in;
    const std::size_t taken = locked([&] { return usb.taken.size(); });
    if (monotonic_ns() - before_ns >= kLoopGone_ns) continue;  // a busy PC: silent indeed
    EXPECT_FALSE(stood_in);
    EXPECT_EQ(taken, 1u);
    return;
  }
  FAIL() << "ten times slower than " << kLoopGone_ns << " ns";
}

TEST_F(LibusbPipeTest, TwoCommandsAreUnderWayAndTheNewestOfTheOthersFollows) {
  for (int i = 0; i < 10; ++i, pipe.reset(), open()) {
    locked([&] { usb.commands.clear(), usb.keeps_out = true; });
    const std::int64_t before_ns = monotonic_ns();
    for (int k = 1; k <= 6; ++k) {
      EXPECT_TRUE(pipe->submit(numbered(k)));
      const auto expected = static_cast<std::size_t>(std::min(k, 2));
      ASSERT_TRUE(
          wait_for([&] { return locked([&] { return usb.commands.size() >= expected; }); }));
      usb_pause_ns(2'000'000);
    }
    const std::size_t under_way = locked([&] { return usb.commands.size(); });
    locked([&] {
      usb.keeps_out = false;
      usb.complete(usb.out.front(), LIBUSB_TRANSFER_COMPLETED, tests::Bytes(16));
      usb.out.pop_front();
    });
    ASSERT_TRUE(wait_for([&] { return locked([&] { return usb.commands.size() >= 3; }); }));
    const std::vector<tests::Bytes> commands = locked([&] { return usb.commands; });
    if (monotonic_ns() - before_ns >= kLoopGone_ns) continue;  // a busy PC: silent indeed
    EXPECT_EQ(under_way, 2u);
    ASSERT_EQ(commands.size(), 3u);
    EXPECT_EQ(commands[2], bytes_of(numbered(6)));
    return;
  }
  FAIL() << "ten times slower than " << kLoopGone_ns << " ns";
}

TEST_F(LibusbPipeTest, StoppingSendsTheLastCommandAndEndsTheThreadQuietly) {
  warm_up();
  pipe->stop(last_command);
  pipe->stop(last_command);
  ASSERT_EQ(usb.commands.size(), 1u);
  EXPECT_TRUE(std::ranges::equal(usb.commands[0], last_command));
  EXPECT_TRUE(thread().ended());
  EXPECT_EQ(thread().last_policy(), SCHED_OTHER);
  EXPECT_EQ(usb.transfers, 0);
  EXPECT_EQ(usb.handles, 0);
}

TEST_F(LibusbPipeTest, StoppingDoesNotWaitForADeviceThatTakesNothing) {
  locked([&] { usb.keeps_out = true; });
  pipe->submit(last_command);
  const std::int64_t before_ns = monotonic_ns();
  pipe->stop(last_command);
  EXPECT_LT(monotonic_ns() - before_ns, 1'000'000'000);
}

TEST_F(LibusbPipeTest, AHangUpEndsTheThreadForGoodAfterOneLook) {
  usb_pause_ns(5'000'000);
  locked([&] {
    usb.hang_up = true;  // poll says so without end
    close(usb.other_end);
  });
  ASSERT_TRUE(wait_for([&] { return thread().ended(); }));
  EXPECT_LE(locked([&] { return usb.event_calls; }), 2);
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kUnplugged);
  EXPECT_EQ(thread().last_policy(), SCHED_OTHER);
  EXPECT_FALSE(pipe->submit(last_command));
}

TEST_F(LibusbPipeTest, ATransferThatSaysGoneEndsIt) {
  send({}, LIBUSB_TRANSFER_NO_DEVICE);
  ASSERT_TRUE(wait_for([&] { return thread().ended(); }));
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kUnplugged);
}

TEST_F(LibusbPipeTest, AStallIsNamed) {
  send({}, LIBUSB_TRANSFER_STALL);
  ASSERT_TRUE(wait_for_fault());
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kStalled);
}

TEST_F(LibusbPipeTest, AfterAStallCommandsStillReachTheDeviceAndStoppingSendsTheLast) {
  send({}, LIBUSB_TRANSFER_STALL);
  ASSERT_TRUE(wait_for_fault());
  std::vector<tests::Bytes> expected;
  const std::int64_t before_ns = monotonic_ns();
  for (int i = 1; i <= 4; ++i) {
    EXPECT_TRUE(pipe->submit(numbered(i)));
    expected.push_back(bytes_of(numbered(i)));
    ASSERT_TRUE(wait_for([&] { return locked([&] { return of_loop(usb.taken) == expected; }); }));
  }
  pipe->stop(numbered(5));
  expected.push_back(bytes_of(numbered(5)));
  EXPECT_EQ(of_loop(usb.taken), expected);
  if (monotonic_ns() - before_ns < kLoopGone_ns) EXPECT_EQ(usb.taken, expected);
  EXPECT_EQ(usb.cleared,
            std::vector<unsigned>{falcon::kFalconEndpointIn});  // for whoever opens it next
}

TEST_F(LibusbPipeTest, AStalledCommandEndpointIsClearedForTheCommandsThatFollow) {
  locked([&] { usb.out_stalls = 1; });
  EXPECT_TRUE(pipe->submit(encode(falcon::FalconCommand{.motor = {900, 900, 900}})));
  ASSERT_TRUE(wait_for_fault());
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kStalled);
  ASSERT_TRUE(wait_for([&] { return locked([&] { return !usb.cleared.empty(); }); }));
  EXPECT_EQ(usb.cleared.front(), falcon::kFalconEndpointOut);
  EXPECT_TRUE(pipe->submit(zero_command));
  ASSERT_TRUE(wait_for([&] { return locked([&] { return !usb.taken.empty(); }); }));
  EXPECT_TRUE(std::ranges::equal(usb.taken[0], zero_command));
}

TEST_F(LibusbPipeTest, StoppingSendsTheLastCommandAgainUntilItIsTaken) {
  // It has 50 ms for it. A busy machine may take those: one of ten stops has them.
  for (int i = 0; i < 10 && usb.taken.empty(); ++i) {
    pipe.reset();
    open();
    warm_up();
    usb.taken.clear();
    locked([&] { usb.out_stalls = 2; });
    pipe->stop(last_command);
  }
  ASSERT_EQ(usb.taken.size(), 1u);
  EXPECT_TRUE(std::ranges::equal(usb.taken[0], last_command));
}

TEST_F(LibusbPipeTest, GoneAfterAStallIsGone) {
  send({}, LIBUSB_TRANSFER_STALL);
  ASSERT_TRUE(wait_for_fault());
  locked([&] { usb.submit_error = LIBUSB_ERROR_NO_DEVICE; });
  EXPECT_TRUE(pipe->submit(zero_command));
  ASSERT_TRUE(wait_for([&] { return thread().ended(); }));
  EXPECT_FALSE(pipe->submit(zero_command));
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kStalled);  // the first one is the cause
}

TEST_F(LibusbPipeTest, ACommandThatMeetsNoDeviceEndsIt) {
  locked([&] { usb.submit_error = LIBUSB_ERROR_NO_DEVICE; });
  EXPECT_TRUE(pipe->submit(last_command));
  ASSERT_TRUE(wait_for([&] { return thread().ended(); }));
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kUnplugged);
}

TEST_F(LibusbPipeTest, SomeDamagedTransfersAreNoEnd) {
  send({}, LIBUSB_TRANSFER_ERROR);
  send({}, LIBUSB_TRANSFER_OVERFLOW);
  send({0x01});
  send(transfer_of({.counts = {3, 3, 3}}));
  falcon::FalconReply reply;
  ASSERT_TRUE(wait_for([&] { return pipe->newest(reply); }));
  EXPECT_EQ(reply.report.counts[0], 3);
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kOpen);
}

TEST_F(LibusbPipeTest, ReadinessWithoutEndAndWithoutResultIsLeftWithoutSpinning) {
  const std::int64_t before_ns = monotonic_ns();
  const char one = 1;
  ASSERT_EQ(::write(usb.other_end, &one, 1), 1);  // nobody reads it: poll returns at once for ever
  ASSERT_TRUE(wait_for_fault());
  const int pauses = FalconTurns::kMaxEmpty - FalconTurns::kFree - 1;
  EXPECT_GE(monotonic_ns() - before_ns, pauses * FalconTurns::kPause_ns);
  usb_pause_ns(20'000'000);  // it stays for the commands, and pauses after each look
  const int calls = locked([&] { return usb.event_calls; });
  const std::int64_t paused = (monotonic_ns() - before_ns) / FalconTurns::kPause_ns;
  EXPECT_LE(calls, FalconTurns::kFree + 2 + paused);
  EXPECT_TRUE(pipe->submit(zero_command));
  EXPECT_TRUE(wait_for([&] { return locked([&] { return !usb.taken.empty(); }); }));
  EXPECT_EQ(locked([&] { return usb.taken[0]; }), bytes_of(zero_command));
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kBroken);
}

}  // namespace tact::hal::falcon_usb::libusb_pipe_test
