// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_bus.h"

#include <gtest/gtest.h>

#include <ctime>

#include "tests/support/can_drives.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::can::can_bus_test {

CanFrame frame(std::uint32_t id) {
  CanFrame out = make_can_frame(id, 8);
  out.data[0] = static_cast<std::uint8_t>(id);
  return out;
}

struct Bus {
  Bus() : wire([] {}), bus(wire.bus()) {}
  tests::ScriptedBus wire;
  std::unique_ptr<CanBus> bus;
};

TEST(CanBus, OneCallBringsEverythingInOrder) {
  Bus b;
  for (std::uint32_t id = 1; id <= 5; ++id) b.wire.say(frame(id));
  const tests::NoAlloc guard;
  const auto received = b.bus->receive();
  EXPECT_EQ(guard.calls(), 0u);
  ASSERT_EQ(received.size(), 5u);
  for (std::uint32_t id = 1; id <= 5; ++id) EXPECT_EQ(received[id - 1].frame, frame(id));
  EXPECT_EQ(b.wire.socket().calls, 1);
  EXPECT_TRUE(b.bus->receive().empty());
}

TEST(CanBus, OneCallSendsTheWholeBatchInOrder) {
  Bus b;
  const tests::NoAlloc guard;
  for (std::uint32_t id = 1; id <= 16; ++id) b.bus->push(frame(id));
  b.bus->send();
  b.bus->send();  // nothing left: no call
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_EQ(b.wire.socket().calls, 1);
  const auto heard = b.wire.hear_all();
  ASSERT_EQ(heard.size(), 16u);
  for (std::uint32_t id = 1; id <= 16; ++id) EXPECT_EQ(heard[id - 1], frame(id));
  EXPECT_EQ(b.bus->counts().missed_cycles, 0u);
}

TEST(CanBus, MoreThanOneReadTakesIsLeftForTheNextAndReported) {
  Bus b;
  for (int i = 0; i < 70; ++i) b.wire.say(frame(1));
  std::size_t heard = b.bus->receive().size();
  EXPECT_EQ(heard, 64u);
  EXPECT_TRUE(b.bus->was_cut_short());
  heard += b.bus->receive().size();
  EXPECT_FALSE(b.bus->was_cut_short());
  EXPECT_EQ(heard, 70u);
}

TEST(CanBus, InvalidFrameIsAMissedCycleAndTheOtherFramesAreSent) {
  Bus b;
  b.bus->push(frame(1));
  b.bus->push(std::nullopt);  // such as a torque that is no number
  b.bus->send();
  EXPECT_EQ(b.wire.hear_all().size(), 1u);
  EXPECT_EQ(b.bus->counts().missed_cycles, 1u);
  for (std::uint32_t id = 0; id < 17; ++id) b.bus->push(frame(id));
  b.bus->send();
  EXPECT_EQ(b.wire.hear_all().size(), 16u);
  EXPECT_EQ(b.bus->counts().missed_cycles, 2u);
}

TEST(CanBus, AFullQueueOfTheKernelIsAMissedCycle) {
  Bus b;  // a real one: the other end is not read
  std::uint64_t sent = 0;
  while (b.bus->counts().missed_cycles == 0 && sent < 100'000) {
    for (std::uint32_t id = 1; id <= 16; ++id) b.bus->push(frame(id));
    b.bus->send();
    ++sent;
  }
  EXPECT_EQ(b.bus->counts().missed_cycles, 1u);
  EXPECT_EQ(b.bus->fault(), Fault::kNone);
  b.wire.hear_all();
  b.bus->push(frame(0x7F));
  b.bus->send();
  const auto heard = b.wire.hear_all();
  ASSERT_EQ(heard.size(), 1u) << "what was missed is not sent later";
  EXPECT_EQ(heard[0].id, 0x7Fu);
}

TEST(CanBus, MissedCyclesCountInARowOnly) {
  Bus b;
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i < CanBus::kMaxMissedInARow - 1; ++i) {
      b.wire.socket().send_error = ENOBUFS;
      b.bus->push(frame(1));
      b.bus->send();
    }
    b.wire.socket().send_error = 0;
    b.bus->push(frame(1));
    b.bus->send();
    b.wire.hear_all();
  }
  EXPECT_EQ(b.bus->fault(), Fault::kNone);
}

TEST(CanBus, APeerThatIsGoneIsABusThatIsDown) {
  Bus b;
  b.wire.unplug();
  b.bus->push(frame(1));
  b.bus->send();
  EXPECT_EQ(b.bus->fault(), Fault::kBusDown);
  EXPECT_NE(can_bus_fault_detail(b.bus->cause(), "can3").find("can3: Connection"),
            std::string::npos)
      << can_bus_fault_detail(b.bus->cause(), "can3");
}

TEST(CanBus, UnreadableFramesAreCountedAndDropped) {
  Bus b;
  CanFrameBytes extended{};
  extended[3] = 0x80;
  b.wire.say_bytes(extended);
  CanFrameBytes long_one{};
  long_one[4] = 9;
  b.wire.say_bytes(long_one);
  b.wire.say(frame(2));
  EXPECT_EQ(b.bus->receive().size(), 1u);
  EXPECT_EQ(b.bus->counts().unreadable, 2u);
}

TEST(CanBus, ErrorFramesAreNoFramesOfDrives) {
  Bus b;
  b.wire.say_error(0x020, 0);
  EXPECT_TRUE(b.bus->receive().empty());
  EXPECT_EQ(b.bus->counts().error_frames, 1u);
  EXPECT_EQ(b.bus->errors_seen().classes, 0x020u);
  EXPECT_EQ(b.bus->fault(), Fault::kNone);
}

TEST(CanSocket, KnowsHowLongAFrameLayInTheQueue) {
  int fds[2] = {-1, -1};
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0, fds), 0);
  CanSocket host(fds[0]);
  const CanFrameBytes bytes{};
  ASSERT_EQ(send(fds[1], bytes.data(), bytes.size(), 0), 16);
  const timespec while_ns{.tv_sec = 0, .tv_nsec = 20'000'000};
  nanosleep(&while_ns, nullptr);
  ASSERT_EQ(send(fds[1], bytes.data(), bytes.size(), 0), 16);
  std::array<CanArrival, 4> in;
  ASSERT_EQ(host.receive(in), 2);
  EXPECT_GE(in[0].age_ns, 20'000'000);
  EXPECT_GE(in[0].age_ns - in[1].age_ns, 20'000'000);
  EXPECT_GE(in[1].age_ns, 0);
  // A datagram of another length is nothing that can be read.
  ASSERT_EQ(send(fds[1], bytes.data(), 7, 0), 7);
  ASSERT_EQ(host.receive(in), 1);
  EXPECT_EQ(in[0].bytes, CanFrameBytes{});
  close(fds[1]);
}

}  // namespace tact::hal::can::can_bus_test
