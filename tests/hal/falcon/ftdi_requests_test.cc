// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/ftdi_requests.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>
#include <vector>

#include "tests/support/no_alloc.h"

namespace tact::hal::falcon::ftdi_requests_test {

using Bytes = std::vector<std::uint8_t>;

/// Packets of 62 bytes with their status, the last one shorter.
Bytes transfer_of(const Bytes& data) {
  Bytes out;
  for (std::size_t at = 0; at <= data.size(); at += 62) {
    if (at == data.size() && at > 0) break;
    out.insert(out.end(), {0x01, 0x60});
    for (std::size_t i = at; i < std::min(at + 62, data.size()); ++i) out.push_back(data[i]);
  }
  return out;
}
Bytes counted(std::size_t size) {
  Bytes out;
  for (std::size_t i = 0; i < size; ++i) out.push_back(static_cast<std::uint8_t>(i * 3));
  return out;
}

TEST(FtdiRequests, EventCharacterRtsAndLatencyRequestsAreEncoded) {
  EXPECT_EQ(ftdi_event_character(0x3E), (FtdiRequest{.type = 0x40, .request = 6, .value = 0x013E}));
  EXPECT_EQ(kFtdiRtsHigh, (FtdiRequest{.type = 0x40, .request = 1, .value = 0x0202}));
  EXPECT_EQ(ftdi_latency_ms(0), ftdi_latency_ms(1));  // 0 is no time the chip has
  EXPECT_EQ(ftdi_latency_ms(255).value, 255);
}

TEST(FtdiRequests, ADivisorThatTheChipLacksHasNoSpeed) {
  for (const std::uint16_t code :
       std::initializer_list<std::uint16_t>{0x4000, 0x8000, 0xC000, 0x4001, 0x8001, 0xC001})
    EXPECT_FALSE(ftdi_baud_Hz(code)) << code;
  EXPECT_EQ(ftdi_baud_Hz(0x4002), 3e6 / 2.5);
}

TEST(FtdiRequests, StrippingGivesTheDataBackAtEverySize) {
  for (std::size_t size = 0; size < 300; ++size) {
    const Bytes data = counted(size), transfer = transfer_of(data);
    Bytes out(size);
    const auto read = ftdi_strip(transfer, out);
    ASSERT_TRUE(read) << size;
    EXPECT_EQ(read->size, size);
    EXPECT_EQ(out, data);
    Bytes in_place = transfer;
    ASSERT_TRUE(ftdi_strip(in_place, in_place));
    in_place.resize(size);
    EXPECT_EQ(in_place, data);
  }
}

TEST(FtdiRequests, ATransferWithoutItsStatusIsDamage) {
  std::array<std::uint8_t, 256> out{};
  EXPECT_FALSE(ftdi_strip({}, out));
  for (const std::size_t size : {1u, 65u, 129u}) EXPECT_FALSE(ftdi_strip(Bytes(size), out)) << size;
  for (const std::size_t size : {2u, 64u, 66u, 128u}) EXPECT_TRUE(ftdi_strip(Bytes(size), out));
}

TEST(FtdiRequests, TooSmallBufferIsRefusedAndUnchanged) {
  const Bytes transfer = transfer_of(counted(100));
  Bytes out(99, 0xEE);
  EXPECT_FALSE(ftdi_strip(transfer, out));
  EXPECT_EQ(out, Bytes(99, 0xEE));
}

TEST(FtdiRequests, AnErrorInAnyPacketIsKeptAndTheModemIsTheLatest) {
  Bytes transfer = transfer_of(counted(150));
  transfer[0] = 0x11;
  transfer[1] = 0x60 | kFtdiOverrun;
  transfer[64] = 0x01;
  transfer[65] = kFtdiFraming;
  transfer[128] = 0x21;
  transfer[129] = 0x20;
  Bytes out(150);
  const auto read = ftdi_strip(transfer, out);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->modem, 0x21);
  EXPECT_FALSE(read->clear_to_send());
  EXPECT_EQ(read->line, 0x20 | kFtdiOverrun | kFtdiFraming);
}

TEST(FtdiRequests, OnlyLineErrorBitsHaveAMessage) {
  std::set<std::string> messages;
  for (unsigned bit = 1; bit <= 0x80; bit <<= 1) {
    const std::string words = ftdi_line_error(static_cast<std::uint8_t>(bit));
    EXPECT_EQ(!words.empty(), (bit & kFtdiLineErrors) != 0) << bit;
    if (!words.empty()) messages.insert(words);
  }
  EXPECT_EQ(messages.size(), 4u);
}

TEST(FtdiRequests, StrippingLeavesTheHeapAlone) {
  Bytes transfer = transfer_of(counted(100));
  const tests::NoAlloc guard;
  (void)ftdi_strip(transfer, transfer);
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::hal::falcon::ftdi_requests_test
