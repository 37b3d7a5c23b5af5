// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/falcon_receiver.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/no_alloc.h"

namespace tact::hal::falcon_usb::falcon_receiver_test {

std::vector<std::uint8_t> transfer_of(const std::vector<falcon::FalconReport>& reports,
                                      std::uint8_t line = 0x60) {
  std::vector<std::uint8_t> bytes{0x01, line};
  for (const falcon::FalconReport& report : reports) {
    const falcon::FalconPacket packet = encode(report);
    bytes.insert(bytes.end(), packet.begin(), packet.end());
  }
  return bytes;
}

TEST(FalconReceiver, AReportMayBeCutAnywhere) {
  const falcon::FalconReport report{.counts = {1, -2, 3}, .buttons = 5, .homed = 7};
  const falcon::FalconPacket packet = encode(report);
  for (std::size_t cut = 0; cut <= packet.size(); ++cut) {
    FalconReceiver receiver;
    const auto at = static_cast<std::ptrdiff_t>(cut);
    std::vector<std::uint8_t> first{1, 0x60}, second{1, 0x60};
    first.insert(first.end(), packet.begin(), packet.begin() + at);
    second.insert(second.end(), packet.begin() + at, packet.end());
    receiver.take(first, 10);
    receiver.take(second, 20);
    falcon::FalconReply reply;
    ASSERT_TRUE(receiver.newest(reply)) << cut;
    EXPECT_EQ(reply.report, report);
    EXPECT_EQ(reply.stamp_ns, cut == packet.size() ? 10 : 20);
    EXPECT_FALSE(receiver.newest(reply));
  }
}

TEST(FalconReceiver, StatusAloneIsNoReport) {
  FalconReceiver receiver;
  falcon::FalconReply reply;
  receiver.take(transfer_of({}), 1);
  EXPECT_FALSE(receiver.newest(reply));
  EXPECT_EQ(receiver.health().dropped_bytes, 0u);
}

TEST(FalconReceiver, DamageAndLineErrorsAreCountedAndReported) {
  FalconReceiver receiver;
  receiver.take(std::vector<std::uint8_t>{0x01}, 1);           // no status
  receiver.take(std::vector<std::uint8_t>{1, 0x60, 9, 9}, 1);  // not a packet
  receiver.take(transfer_of({}, 0x62), 1);
  receiver.take(transfer_of({}, 0x68), 1);
  EXPECT_EQ(receiver.health().dropped_bytes, 3u);
  EXPECT_EQ(receiver.health().line_errors, falcon::kFtdiOverrun | falcon::kFtdiFraming);
  EXPECT_EQ(receiver.health().end, falcon::FalconPipeEnd::kOpen);
}

TEST(FalconReceiver, FirstCauseOfTheEndIsKept) {
  FalconReceiver receiver;
  EXPECT_TRUE(receiver.open());
  receiver.finish(falcon::FalconPipeEnd::kStalled, 32);
  receiver.finish(falcon::FalconPipeEnd::kUnplugged, 19);
  EXPECT_FALSE(receiver.open());
  EXPECT_EQ(receiver.health().end, falcon::FalconPipeEnd::kStalled);
  EXPECT_EQ(receiver.health().error, 32);
}

TEST(FalconReceiver, LeavesTheHeapAlone) {
  FalconReceiver receiver;
  const auto transfer = transfer_of({{.counts = {1, 2, 3}}, {.counts = {4, 5, 6}}});
  const tests::NoAlloc guard;
  for (int i = 0; i < 100; ++i) receiver.take(transfer, i);
  EXPECT_EQ(guard.calls(), 0u);
}

TEST(FalconTurns, EmptyTurnsPauseAndEndTheThreadAfterTheMaximum) {
  FalconTurns turns;
  int free = 0, pauses = 0;
  auto next = turns.turn(false);
  for (; next != FalconTurns::Next::kEnd && free + pauses < 1000; next = turns.turn(false))
    ++(next == FalconTurns::Next::kPause ? pauses : free);
  EXPECT_EQ(free, FalconTurns::kFree);
  EXPECT_EQ(free + pauses + 1, FalconTurns::kMaxEmpty);
  EXPECT_EQ(turns.turn(true), FalconTurns::Next::kGoOn);
  EXPECT_EQ(turns.turn(false), FalconTurns::Next::kGoOn);
}

}  // namespace tact::hal::falcon_usb::falcon_receiver_test
