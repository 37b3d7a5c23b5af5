// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/canopen_frames.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <vector>

#include "tests/support/no_alloc.h"

namespace tact::hal::cia402::canopen_frames_test {

const std::vector<int> kNoNodes{-1, 128, 1 << 12, std::numeric_limits<int>::min()};

can::CanFrame from(std::uint32_t base, int node, std::vector<std::uint8_t> bytes) {
  can::CanFrame frame = can::make_can_frame(base + static_cast<std::uint32_t>(node),
                                            static_cast<std::uint8_t>(bytes.size()));
  std::copy(bytes.begin(), bytes.end(), frame.data.begin());
  return frame;
}

TEST(CanopenFrames, ANodeThatCannotBeIsNeverAddressed) {
  for (const int node : kNoNodes) EXPECT_FALSE(canopen_nmt(NmtCommand::kStart, node)) << node;
  for (const int node : {-1, 0, 128, 1 << 12}) {
    EXPECT_FALSE(canopen_heartbeat(node, NmtState::kOperational)) << node;
    EXPECT_FALSE(canopen_sdo_download(node, {0x6060, 0, 10, 1})) << node;
    EXPECT_FALSE(canopen_sdo_upload(node, 0x6041, 0)) << node;
  }
  EXPECT_TRUE(canopen_nmt(NmtCommand::kStop, kCanopenAllNodes));
  EXPECT_TRUE(canopen_nmt(NmtCommand::kStop, 127));
}

TEST(CanopenFrames, TheHostsHeartbeatReadsBackInEveryState) {
  for (const NmtState state :
       {NmtState::kBoot, NmtState::kStopped, NmtState::kOperational, NmtState::kPreOperational}) {
    const auto frame = canopen_heartbeat(127, state);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->id, 0x77Fu);
    EXPECT_EQ(frame->length, 1);
    EXPECT_EQ(decode_canopen_heartbeat(*frame, 127), state);
  }
}

TEST(CanopenFrames, HeartbeatWithAnUnknownStateIsIgnored) {
  int known = 0;
  for (int byte = 0; byte < 256; ++byte)
    if (decode_canopen_heartbeat(from(0x700, 3, {static_cast<std::uint8_t>(byte)}), 3)) ++known;
  EXPECT_EQ(known, 4);
}

TEST(CanopenFrames, EveryReplyComesFromItsNodeItsMessageAndInFull) {
  const auto check = [](const char* name, auto decode, std::uint32_t base,
                        const std::vector<std::uint8_t>& bytes) {
    const can::CanFrame sound = from(base, 7, bytes);
    EXPECT_TRUE(decode(sound, 7)) << name;
    for (const int node : {6, 8, 0, -1, 128, 135}) EXPECT_FALSE(decode(sound, node)) << name;
    for (std::uint8_t length = 0; length <= 9; ++length) {
      can::CanFrame frame = sound;
      frame.length = length;
      EXPECT_EQ(decode(frame, 7).has_value(), length == bytes.size()) << name << int{length};
    }
    for (std::uint32_t other = 0; other <= 0x780; other += 0x80) {
      can::CanFrame frame = sound;
      frame.id = other + 7;
      EXPECT_EQ(decode(frame, 7).has_value(), other == base) << name << other;
    }
    can::CanFrame remote = sound;
    remote.rtr = true;
    EXPECT_FALSE(decode(remote, 7)) << name;
  };
  check("heartbeat", decode_canopen_heartbeat, 0x700, {5});
  check("emergency", decode_canopen_emergency, 0x080, {0x10, 0x23, 1, 0, 0, 0, 0, 0});
  check("sdo", decode_canopen_sdo, 0x580, {0x60, 0x60, 0x60, 0, 0, 0, 0, 0});
  EXPECT_FALSE(decode_canopen_emergency(can::make_can_frame(0x080, 8), 0))
      << "SYNC is no node's error";
}

TEST(CanopenFrames, ASettingThatDoesNotFitItsSizeIsNotWritten) {
  EXPECT_TRUE(canopen_sdo_download(1, {0x6060, 0, 0xFF, 1}));
  EXPECT_FALSE(canopen_sdo_download(1, {0x6060, 0, 0x100, 1}));
  EXPECT_TRUE(canopen_sdo_download(1, {0x1017, 0, 0xFFFF, 2}));
  EXPECT_FALSE(canopen_sdo_download(1, {0x1017, 0, 0x10000, 2}));
  EXPECT_TRUE(canopen_sdo_download(1, {0x1400, 1, 0xFFFFFFFF, 4}));
  for (const std::uint8_t size : std::vector<std::uint8_t>{0, 3, 5, 8, 255})
    EXPECT_FALSE(canopen_sdo_download(1, {0x6060, 0, 0, size})) << int{size};
}

TEST(CanopenFrames, OnlyAnExpeditedReplyIsRead) {
  std::set<int> read;
  for (int command = 0; command < 256; ++command) {
    const auto frame =
        from(0x580, 1, {static_cast<std::uint8_t>(command), 0x64, 0x60, 0, 1, 2, 3, 4});
    if (decode_canopen_sdo(frame, 1)) read.insert(command);
  }
  EXPECT_EQ(read, (std::set<int>{0x42, 0x43, 0x47, 0x4B, 0x4F, 0x60, 0x80}));
}

TEST(CanopenFrames, AnUploadHasAsManyBytesAsItSays) {
  const auto value = [](std::uint8_t command) {
    return decode_canopen_sdo(from(0x580, 1, {command, 0x64, 0x60, 2, 1, 2, 3, 4}), 1);
  };
  EXPECT_EQ(value(0x4F)->value, 0x01u);
  EXPECT_EQ(value(0x4B)->value, 0x0201u);
  EXPECT_EQ(value(0x47)->value, 0x030201u);
  EXPECT_EQ(value(0x43)->value, 0x04030201u);
  EXPECT_EQ(value(0x47)->size, 3);
  EXPECT_EQ(value(0x42)->value, 0x04030201u) << "without a size: who asks knows it";
  EXPECT_EQ(value(0x42)->size, 0);
  EXPECT_EQ(value(0x43)->index, 0x6064);
  EXPECT_EQ(value(0x43)->sub, 2);
}

TEST(CanopenFrames, LeavesTheHeapAlone) {
  const can::CanFrame reply = can::make_can_frame(0x707, 1);
  const tests::NoAlloc guard;
  const auto beat = decode_canopen_heartbeat(reply, 7);
  const auto write = canopen_sdo_download(7, {0x6060, 0, 10, 1});
  const can::CanFrame sync = canopen_sync();
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_TRUE(beat && write && sync.length == 0);
}

}  // namespace tact::hal::cia402::canopen_frames_test
