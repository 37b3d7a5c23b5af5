// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

#include "tests/hal/falcon_usb/usbfs_bus.h"

namespace tact::tests::usbfs_pipe_end_test {

TEST(UsbfsPipeEnd, APulledDeviceEndsTheThreadForGood) {
  for (const int error : {ENODEV, ESHUTDOWN}) {
    Bus bus;
    const auto pipe = start(bus);
    ASSERT_TRUE(bus.wait_for([&] { return bus.reaps > 0; }));
    bus.change([&] { bus.reap_error = error; });  // and again, without end
    ASSERT_TRUE(wait_for_end(*pipe));
    EXPECT_LE(bus.reaps, 2);
    EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kUnplugged);
    EXPECT_EQ(pipe->health().error, error);
    EXPECT_EQ(thread_of(*pipe).last_policy(), SCHED_OTHER);
    EXPECT_FALSE(pipe->submit(last_command));
  }
}

TEST(UsbfsPipeEnd, ShutdownStatusOfATransferEndsTheThread) {
  Bus bus;
  const auto pipe = start(bus);
  bus.send({}, -ESHUTDOWN);
  ASSERT_TRUE(wait_for_end(*pipe));
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kUnplugged);
}

TEST(UsbfsPipeEnd, ACommandThatMeetsNoDeviceReportsSoAtOnce) {
  Bus bus;
  const auto pipe = start(bus);
  bus.change([&] { bus.submit_error = ENODEV; });
  EXPECT_FALSE(pipe->submit(last_command));
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kUnplugged);
}

TEST(UsbfsPipeEnd, NoMemoryForACommandIsAMissedCycleOnly) {
  Bus bus;
  const auto pipe = start(bus);
  bus.change([&] { bus.submit_error = ENOMEM; });
  EXPECT_FALSE(pipe->submit(last_command));
  bus.change([&] { bus.submit_error = 0; });
  EXPECT_TRUE(pipe->submit(last_command));
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kOpen);
}

TEST(UsbfsPipeEnd, AStallIsNamed) {
  Bus bus;
  const auto pipe = start(bus);
  bus.send({}, -EPIPE);
  ASSERT_TRUE(wait_for_fault(*pipe));
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kStalled);
}

TEST(UsbfsPipeEnd, AfterAStallCommandsReachTheDeviceAndStopSendsTheLast) {
  Bus bus;
  const auto pipe = start(bus);
  for (std::size_t i = 0; i < falcon_usb::UsbfsPipe::kIn; ++i)
    bus.send({}, -EPIPE);  // nothing is under way
  ASSERT_TRUE(wait_for_fault(*pipe));
  std::vector<falcon::FalconPacket> expected;
  const std::int64_t before_ns = monotonic_ns();
  for (int i = 1; i <= 4; ++i) {
    expected.push_back(encode(falcon::FalconCommand{.motor = {i, -i, 7}}));
    EXPECT_TRUE(pipe->submit(expected.back()));
    ASSERT_TRUE(
        bus.wait_for([&] { return Bus::of_loop(bus.taken) == expected && bus.done.empty(); }));
    falcon_usb::usb_pause_ns(2'000'000);
  }
  expected.push_back(encode(falcon::FalconCommand{.motor = {5, -5, 7}}));
  pipe->stop(expected.back());
  EXPECT_EQ(Bus::of_loop(bus.taken), expected);
  if (monotonic_ns() - before_ns < kLoopGone_ns) EXPECT_EQ(bus.taken, expected);
  EXPECT_EQ(bus.cleared,
            std::vector<unsigned>{falcon::kFalconEndpointIn});  // for the next one to open it
}

TEST(UsbfsPipeEnd, AfterAStallASilentLoopIsReplacedByZerosToo) {
  Bus bus;
  const auto pipe = start(bus);
  EXPECT_TRUE(pipe->submit(encode(falcon::FalconCommand{.motor = {900, 900, 900}})));
  for (std::size_t i = 0; i < falcon_usb::UsbfsPipe::kIn; ++i)
    bus.send({}, -EPIPE);  // nothing is under way
  ASSERT_TRUE(bus.wait_for([&] { return bus.taken.size() >= 2; }));
  EXPECT_EQ(bus.taken_now()[1], falcon_usb::LoopSilence::zero());
}

TEST(UsbfsPipeEnd, AStalledCommandEndpointIsClearedForTheCommandsThatFollow) {
  Bus bus;
  bus.out_stalls = 1;
  const auto pipe = start(bus);
  EXPECT_TRUE(pipe->submit(encode(falcon::FalconCommand{.motor = {900, 900, 900}})));
  ASSERT_TRUE(wait_for_fault(*pipe));
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kStalled);
  ASSERT_TRUE(bus.wait_for([&] { return !bus.cleared.empty(); }));
  EXPECT_EQ(bus.cleared.front(), falcon::kFalconEndpointOut);
  EXPECT_TRUE(pipe->submit(zero_command));
  ASSERT_TRUE(bus.wait_for([&] { return !bus.taken.empty(); }));
  EXPECT_EQ(bus.taken[0], zero_command);
}

TEST(UsbfsPipeEnd, StoppingSendsTheLastCommandAgainUntilItIsTaken) {
  // It has 50 ms for it. A busy machine may take those: one of ten stops has them.
  const std::vector<falcon::FalconPacket> once{last_command};
  std::vector<falcon::FalconPacket> taken;
  for (int i = 0; i < 10 && taken != once; ++i) {
    Bus bus;
    bus.out_stalls = 2;
    const auto pipe = start(bus);
    pipe->stop(last_command);
    taken = bus.taken;
  }
  EXPECT_EQ(taken, once);
}

TEST(UsbfsPipeEnd, AForceThatWaitsBehindAStalledCommandIsDropped) {
  Bus bus;
  bus.swallow_out = true;
  const auto pipe = start(bus);
  const falcon::FalconPacket push = encode(falcon::FalconCommand{.motor = {900, 900, 900}});
  EXPECT_TRUE(pipe->submit(push));
  EXPECT_TRUE(pipe->submit(push));
  bus.change([&] {
    bus.finish(bus.out, -EPIPE, 0);
    bus.swallow_out = false;
  });
  ASSERT_TRUE(bus.wait_for([&] { return !bus.cleared.empty(); }));
  EXPECT_EQ(bus.discards, 2);
  EXPECT_TRUE(bus.out.empty());
  pipe->stop(last_command);
  EXPECT_EQ(bus.taken, std::vector<falcon::FalconPacket>{last_command});
}

TEST(UsbfsPipeEnd, UnplugAfterAStallEndsTheThreadAndKeepsTheFirstCause) {
  Bus bus;
  const auto pipe = start(bus);
  bus.send({}, -EPIPE);
  ASSERT_TRUE(wait_for_fault(*pipe));
  bus.change([&] { bus.reap_error = ENODEV; });
  ASSERT_TRUE(wait_for_end(*pipe));
  EXPECT_FALSE(pipe->submit(zero_command));
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kStalled);  // the first one is the cause
}

TEST(UsbfsPipeEnd, OneDamagedTransferIsNoEnd) {
  Bus bus;
  const auto pipe = start(bus);
  for (const int status : {-EPROTO, -EOVERFLOW, -EILSEQ}) bus.send({}, status);
  bus.send({0x01});  // shorter than its status
  bus.send({});
  bus.send(transfer_of({.counts = {3, 3, 3}}));
  EXPECT_EQ(wait_for_reply(*pipe, 1).report.counts[0], 3);
  EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kOpen);
  EXPECT_EQ(pipe->health().dropped_bytes, 2u);
}

TEST(UsbfsPipeEnd, ABusThatAnswersNothingAtOnceForEverIsLeftWithoutSpinning) {
  struct Storm {
    int status, size, error;
  };
  for (const Storm& storm :
       {Storm{-EPROTO, 0, EPROTO}, Storm{0, 0, EIO}, Storm{-ENOENT, 0, ENOENT}}) {
    Bus bus;
    const auto pipe = start(bus);
    const std::int64_t before_ns = monotonic_ns();
    bus.change([&] {
      bus.in_storm = true;
      bus.in_status = storm.status;
      bus.in_size = storm.size;
      while (!bus.in.empty()) bus.finish(bus.in, storm.status, storm.size);
    });
    ASSERT_TRUE(wait_for_fault(*pipe));
    EXPECT_EQ(pipe->health().end, falcon::FalconPipeEnd::kBroken);
    EXPECT_EQ(pipe->health().error, storm.error);
    const int pauses =
        falcon_usb::FalconTurns::kMaxEmpty - falcon_usb::FalconTurns::kFree - 1;  // others may run
    EXPECT_GE(monotonic_ns() - before_ns, pauses * falcon_usb::FalconTurns::kPause_ns);
    falcon_usb::usb_pause_ns(10'000'000);
    const int in_urbs =
        static_cast<int>(falcon_usb::UsbfsPipe::kIn);  // each comes back once more at most
    int reaps = 0;
    bus.change([&] { reaps = bus.reaps; });
    EXPECT_LE(reaps, falcon_usb::FalconTurns::kMaxEmpty + in_urbs + 2);
    EXPECT_TRUE(pipe->submit(zero_command));
    EXPECT_TRUE(bus.wait_for([&] { return !bus.taken.empty(); }));
    EXPECT_EQ(bus.taken_now()[0], zero_command);
  }
}

TEST(UsbfsPipeEnd, ADescriptorThatIsNoUsbDeviceEndsAtOnce) {
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
  close(ends[1]);  // hung up
  auto node = std::make_unique<falcon_usb::UsbfsNode>(ends[0], 0, true);
  const auto pipe = falcon_usb::UsbfsPipe::start(std::move(node));
  ASSERT_FALSE(pipe);
  EXPECT_NE(pipe.error().message.find("plug it in again"), std::string::npos);
}

TEST(UsbfsPipeEnd, ANodeThatCannotBeOpenedSaysWhatToDo) {
  const auto missing = falcon_usb::UsbfsNode::open("/dev/bus/usb/nowhere", 0);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("/dev/bus/usb/nowhere"), std::string::npos);
  const auto other = falcon_usb::UsbfsNode::open("/dev/null", 0);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("fuser /dev/null"), std::string::npos);
}

}  // namespace tact::tests::usbfs_pipe_end_test
