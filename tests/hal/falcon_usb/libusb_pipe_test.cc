// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/libusb_pipe.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/socket.h>

#include "hal/monotonic.h"
#include "tests/hal/falcon_usb/fake_libusb.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::falcon_usb::libusb_pipe_test {

class LibusbPipeTest : public testing::Test {
 protected:
  LibusbPipeTest() {
    tests::fake_usb = &usb;
    int ends[2];
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends), 0);
    usb.event_fd = ends[0];
    usb.other_end = ends[1];
    open();
  }
  ~LibusbPipeTest() override {
    pipe.reset();
    EXPECT_EQ(usb.transfers, 0);  // everything was given back
    EXPECT_EQ(usb.claims, 0);
    EXPECT_EQ(usb.handles, 0);
    EXPECT_EQ(usb.contexts, 0);
    close(usb.event_fd);
    if (!usb.hang_up) close(usb.other_end);
    tests::fake_usb = nullptr;
  }
  void open() {
    auto opened = FalconUsb::open("");
    EXPECT_TRUE(opened);
    auto started = LibusbPipe::start(std::move(*opened));
    EXPECT_TRUE(started) << started.error().sentence;
    pipe = std::move(*started);
  }
  template <typename Condition>
  static bool wait_for(Condition condition) {
    for (int i = 0; i < 3000; ++i, usb_pause_ns(1'000'000))
      if (condition()) return true;
    return false;
  }
  template <typename Look>
  auto locked(Look look) {
    const std::lock_guard lock(usb.mutex);
    return look();
  }
  void send(const tests::Bytes& bytes, libusb_transfer_status status = LIBUSB_TRANSFER_COMPLETED) {
    ASSERT_TRUE(wait_for([&] { return locked([&] { return !usb.in.empty(); }); }));
    locked([&] {
      libusb_transfer* transfer = usb.in.front();
      usb.in.pop_front();
      usb.complete(transfer, status, bytes);
    });
  }
  static tests::Bytes transfer_of(const falcon::FalconReport& report) {
    const falcon::FalconPacket packet = encode(report);
    tests::Bytes bytes{0x01, 0x60};
    bytes.insert(bytes.end(), packet.begin(), packet.end());
    return bytes;
  }
  /// An end by an error: the thread stays.
  bool wait_for_fault() {
    return wait_for([&] { return pipe->health().end != falcon::FalconPipeEnd::kOpen; });
  }
  /// The thread has run.
  void warm_up() {
    send(transfer_of({}));
    falcon::FalconReply reply;
    ASSERT_TRUE(wait_for([&] { return pipe->newest(reply); }));
  }
  const UsbThread& thread() const { return dynamic_cast<const LibusbPipe&>(*pipe).thread(); }

  tests::FakeUsb usb;
  std::unique_ptr<falcon::FalconPipe> pipe;
};

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
  ASSERT_TRUE(wait_for([&] { return locked([&] { return usb.commands.size() == 1; }); }));
  EXPECT_TRUE(std::ranges::equal(usb.commands[0], packet));
}

TEST_F(LibusbPipeTest, ALoopThatFallsSilentIsReplacedByZerosWhichIsTold) {
  const falcon::FalconPacket push = encode(falcon::FalconCommand{.motor = {900, 900, 900}});
  EXPECT_FALSE(pipe->health().stood_in);
  for (const bool answers : {true, false}) {  // the adapter's latency timer, or nothing at all
    const std::size_t before = locked([&] { return usb.taken.size(); });
    const std::int64_t before_ns = monotonic_ns();
    EXPECT_TRUE(pipe->submit(push));
    EXPECT_TRUE(wait_for([&] {
      if (answers) send({0x01, 0x60});
      return locked([&] { return usb.taken.size() == before + 2; });
    }));
    EXPECT_GE(monotonic_ns() - before_ns, kLoopGone_ns);
    locked([&] {
      EXPECT_TRUE(std::ranges::equal(usb.taken[before], push));
      EXPECT_TRUE(std::ranges::equal(usb.taken[before + 1], LoopSilence::zero()));
    });
    EXPECT_TRUE(pipe->health().stood_in);
  }
}

TEST_F(LibusbPipeTest, SilenceIsCountedFromTheCommandAndNotFromTheReplyBefore) {
  EXPECT_TRUE(pipe->submit(encode(falcon::FalconCommand{.motor = {900, 900, 900}})));
  EXPECT_TRUE(wait_for([&] { return locked([&] { return usb.taken.size() == 1; }); }));
  for (int i = 0; i < 5; ++i) {  // the first replies ever, some milliseconds later
    send({0x01, 0x60});
    usb_pause_ns(2'000'000);
  }
  EXPECT_FALSE(pipe->health().stood_in);
  EXPECT_EQ(locked([&] { return usb.taken.size(); }), 1u);
}

TEST_F(LibusbPipeTest, TwoCommandsAreUnderWayAndTheNewestOfTheOthersFollows) {
  locked([&] { usb.keeps_out = true; });
  for (int i = 1; i <= 6; ++i) {
    EXPECT_TRUE(pipe->submit(encode(falcon::FalconCommand{.motor = {i, 0, 0}})));
    const auto expected = static_cast<std::size_t>(std::min(i, 2));
    ASSERT_TRUE(wait_for([&] { return locked([&] { return usb.commands.size() >= expected; }); }));
    usb_pause_ns(2'000'000);
  }
  EXPECT_EQ(locked([&] { return usb.commands.size(); }), 2u);
  locked([&] {
    usb.keeps_out = false;
    usb.complete(usb.out.front(), LIBUSB_TRANSFER_COMPLETED, tests::Bytes(16));
    usb.out.pop_front();
  });
  ASSERT_TRUE(wait_for([&] { return locked([&] { return usb.commands.size() == 3; }); }));
  EXPECT_EQ(falcon::decode_falcon_command(usb.commands[2])->motor[0], 6);
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
  for (std::size_t i = 1; i <= 4; ++i) {
    EXPECT_TRUE(pipe->submit(zero_command));
    ASSERT_TRUE(wait_for([&] { return locked([&] { return usb.taken.size() == i; }); }));
  }
  pipe->stop(last_command);
  ASSERT_EQ(usb.taken.size(), 5u);
  EXPECT_TRUE(std::ranges::equal(usb.taken[4], last_command));
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
  EXPECT_TRUE(wait_for([&] { return locked([&] { return usb.taken.size() == 1; }); }));
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kBroken);
}

}  // namespace tact::hal::falcon_usb::libusb_pipe_test
