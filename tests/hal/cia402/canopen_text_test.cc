// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/canopen_text.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace tact::hal::cia402::canopen_words_test {

TEST(CanopenText, EveryCodeHasAMessage) {
  for (std::uint32_t code = 0; code <= 0xFFFF; ++code)
    ASSERT_GT(std::string(emergency_message(static_cast<std::uint16_t>(code))).size(), 20u);
  for (const std::uint32_t code : {0u, 1u, 0x06040041u, 0x06090011u, 0x08000022u, 0x05040000u,
                                   0x08000024u, 0x12345678u, 0xFFFFFFFFu}) {
    EXPECT_GT(std::string(sdo_abort_message(code)).size(), 20u) << code;
  }
}

TEST(CanopenText, AnEntryIsReachedByItsOwnCode) {
  // An entry behind a wider one would never be said.
  for (const CanopenText& one : emergency_texts()) {
    if (one.mask == 0) continue;
    EXPECT_STREQ(emergency_message(static_cast<std::uint16_t>(one.code)), one.message);
  }
  for (const CanopenText& one : sdo_abort_texts()) {
    if (one.mask == 0) continue;
    EXPECT_STREQ(sdo_abort_message(one.code), one.message);
  }
  EXPECT_EQ(emergency_texts().back().mask, 0u);
  EXPECT_EQ(sdo_abort_texts().back().mask, 0u);
}

TEST(CanopenText, AKnownCodeIsNotGuessedFromItsGroup) {
  std::set<std::string> messages;
  for (const std::uint16_t code : std::initializer_list<std::uint16_t>{
           0x0000, 0x2310, 0x2111, 0x3210, 0x3220, 0x3999, 0x4310, 0x4999, 0x7305, 0x7999, 0x8110,
           0x8120, 0x8130, 0x8140, 0x8250, 0x8611, 0xFF01, 0xA000}) {
    messages.insert(emergency_message(code));
  }
  EXPECT_EQ(messages.size(), 18u);
}

TEST(CanopenText, OnlyZeroMeansThatTheErrorsAreGone) {
  const std::string gone = emergency_message(0);
  EXPECT_NE(gone.find("gone"), std::string::npos);
  for (std::uint32_t code = 1; code <= 0xFFFF; ++code)
    ASSERT_NE(emergency_message(static_cast<std::uint16_t>(code)), gone) << code;
}

TEST(CanopenText, SentencesEndAndNameNoCode) {
  for (const auto& table : {emergency_texts(), sdo_abort_texts()}) {
    for (const CanopenText& one : table) {
      const std::string message = one.message;
      EXPECT_TRUE(message.back() == '.' || message.back() == '?') << message;
      EXPECT_EQ(message.find("0x"), std::string::npos) << message;
    }
  }
}

}  // namespace tact::hal::cia402::canopen_words_test
