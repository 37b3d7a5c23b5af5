// SPDX-License-Identifier: Apache-2.0
// CAN FD: frames, and what the bus and its socket make of them.
#include <gtest/gtest.h>

#include <vector>

#include "hal/can/can_bus.h"
#include "hal/can/can_fd_frame.h"
#include "tests/support/can_drives.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::can::can_fd_test {

CanFdFrame frame_of(std::uint32_t id, std::uint8_t length) {
  CanFdFrame frame{.id = id, .length = length, .data = {}};
  for (std::size_t i = 0; i < length; ++i) frame.data[i] = static_cast<std::uint8_t>(i + 1);
  return frame;
}

TEST(CanFdFrame, PackingUndoesUnpackingForEveryLengthAndBothKindsOfIdentifier) {
  for (const std::uint32_t id : {0u, 0x100u, 0x7FFu, 0x800u, 0x8001u, kCanFdLargestId}) {
    for (std::size_t bytes = 0; bytes <= 64; ++bytes) {
      const auto length = can_fd_length(bytes);
      ASSERT_TRUE(length && *length >= bytes);
      const auto packed = pack_can_frame(frame_of(id, *length));
      ASSERT_TRUE(packed);
      EXPECT_EQ((*packed)[3] >> 7, id > 0x7FF ? 1 : 0) << "the flag of an extended identifier";
      EXPECT_EQ((*packed)[5], 5) << "CAN FD, with bit rate switch";
      EXPECT_EQ(unpack_can_fd_frame(*packed), frame_of(id, *length));
    }
  }
  EXPECT_FALSE(can_fd_length(65));
}

TEST(CanFdFrame, InvalidLengthsIdentifiersAndFlagsAreRefused) {
  for (const int cannot_be : {9, 11, 13, 33, 63, 65, 255}) {
    const auto length = static_cast<std::uint8_t>(cannot_be);
    CanFdFrame frame{.id = 1, .length = length, .data = {}};
    EXPECT_FALSE(pack_can_frame(frame)) << cannot_be;
    EXPECT_EQ(most_can_fd_bits(frame).slow, 0);
    CanFdFrameBytes bytes = *pack_can_frame(frame_of(1, 8));
    bytes[4] = length;
    EXPECT_FALSE(unpack_can_fd_frame(bytes)) << cannot_be;
  }
  EXPECT_FALSE(pack_can_frame(frame_of(kCanFdLargestId + 1, 0)));
  CanFdFrameBytes bytes = *pack_can_frame(frame_of(0x8001, 12));
  EXPECT_FALSE(unpack_can_fd_frame(std::span(bytes).first(71)));
  for (const int bit : {5, 6}) {  // error frame, remote request
    CanFdFrameBytes flagged = bytes;
    flagged[3] = static_cast<std::uint8_t>(flagged[3] | 1 << bit);
    EXPECT_FALSE(unpack_can_fd_frame(flagged)) << bit;
  }
  bytes[3] = 0;  // 0x8001 in eleven bits
  EXPECT_FALSE(unpack_can_fd_frame(bytes));
}

TEST(CanFdFrame, DataBeyondTheLengthIsNeverRead) {
  CanFdFrameBytes bytes = *pack_can_frame(frame_of(1, 12));
  bytes[8 + 12] = 99;
  EXPECT_EQ(unpack_can_fd_frame(bytes), frame_of(1, 12));
}

TEST(CanFdFrame, BitsAreThoseOfIsoAtWorstStuffing) {
  // 17 bits to the bit rate switch, 4 stuffed, 13 behind; 5 + 8 n in front of the checksum.
  const CanFdBits none = most_can_fd_bits(frame_of(1, 0));
  EXPECT_EQ(none.slow, 34);
  EXPECT_EQ(none.fast, 5 + 1 + 27);
  const CanFdBits full = most_can_fd_bits(frame_of(0x8001, 64));
  EXPECT_EQ(full.slow, 36 + 8 + 13);
  EXPECT_EQ(full.fast, 517 + 129 + 32);
}

struct Bus {
  Bus() : wire([] {}), bus(wire.bus()) {}
  tests::ScriptedFdBus wire;
  std::unique_ptr<CanFdBus> bus;
};

TEST(CanFdBus, FramesOf64BytesPassBothWaysInOneCallWithoutHeap) {
  Bus b;
  for (std::uint32_t id = 0; id < 3; ++id) b.wire.say(frame_of(0x8000 + id, 64));
  {
    const tests::NoAlloc guard;
    const auto received = b.bus->receive();
    ASSERT_EQ(received.size(), 3u);
    for (std::uint32_t id = 0; id < 3; ++id)
      EXPECT_EQ(received[id].frame, frame_of(0x8000 + id, 64));
    for (std::uint32_t id = 0; id < 16; ++id) b.bus->push(frame_of(id, 32));
    b.bus->send();
    EXPECT_EQ(guard.calls(), 0u);
  }
  EXPECT_EQ(b.wire.socket().calls, 2);
  EXPECT_EQ(b.wire.hear_all().size(), 16u);
  EXPECT_EQ(b.bus->counts().missed_cycles, 0u);
}

TEST(CanFdBus, BusOffErrorFrameLatchesOnACanFdBus) {
  Bus b;
  b.wire.say(frame_of(1, 64));  // its bytes must not stay behind in the shorter ones
  b.bus->receive();
  b.wire.say_error(0x040, 0);
  EXPECT_TRUE(b.bus->receive().empty());
  EXPECT_EQ(b.bus->fault(), Fault::kBusOff);
}

TEST(CanFdBus, AClassicFrameIsReadWithItsOwnBytesAlone) {
  Bus b;
  b.wire.say(frame_of(1, 64));
  b.bus->receive();
  b.wire.say_bytes(*pack_can_frame(make_can_frame(0x123, 3)));
  const auto received = b.bus->receive();
  ASSERT_EQ(received.size(), 1u);
  EXPECT_EQ(received[0].frame, (CanFdFrame{.id = 0x123, .length = 3, .data = {}}));
}

TEST(CanFdBus, ADatagramOfAnotherLengthIsNoFrame) {
  Bus b;
  const std::vector<std::uint8_t> bytes(40, 1);
  b.wire.say_bytes(bytes);
  const auto received = b.bus->receive();
  for (const auto& one : received) EXPECT_EQ(one.frame, CanFdFrame{});
}

TEST(CanFdBus, RemediesNameASetUpOfCanFd) {
  Bus b;
  b.wire.say_error(0x080, 0);
  b.bus->receive();
  EXPECT_NE(silent_bus_detail(*b.bus, "can0").find("dbitrate 5000000 sample-point 0.666"),
            std::string::npos);
}

}  // namespace tact::hal::can::can_fd_test
