// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/canopen_words.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace tact::hal::cia402::canopen_words_test {

TEST(CanopenWords, EveryCodeHasASentence) {
  for (std::uint32_t code = 0; code <= 0xFFFF; ++code)
    ASSERT_GT(std::string(emergency_sentence(static_cast<std::uint16_t>(code))).size(), 20u);
  for (const std::uint32_t code : {0u, 1u, 0x06040041u, 0x06090011u, 0x08000022u, 0x05040000u,
                                   0x08000024u, 0x12345678u, 0xFFFFFFFFu}) {
    EXPECT_GT(std::string(sdo_abort_sentence(code)).size(), 20u) << code;
  }
}

TEST(CanopenWords, AnEntryIsReachedByItsOwnCode) {
  // An entry behind a wider one would never be said.
  for (const CanopenWords& one : emergency_words()) {
    if (one.mask == 0) continue;
    EXPECT_STREQ(emergency_sentence(static_cast<std::uint16_t>(one.code)), one.sentence);
  }
  for (const CanopenWords& one : sdo_abort_words()) {
    if (one.mask == 0) continue;
    EXPECT_STREQ(sdo_abort_sentence(one.code), one.sentence);
  }
  EXPECT_EQ(emergency_words().back().mask, 0u);
  EXPECT_EQ(sdo_abort_words().back().mask, 0u);
}

TEST(CanopenWords, AKnownCodeIsNotGuessedFromItsGroup) {
  std::set<std::string> sentences;
  for (const std::uint16_t code : std::initializer_list<std::uint16_t>{
           0x0000, 0x2310, 0x2111, 0x3210, 0x3220, 0x3999, 0x4310, 0x4999, 0x7305, 0x7999, 0x8110,
           0x8120, 0x8130, 0x8140, 0x8250, 0x8611, 0xFF01, 0xA000}) {
    sentences.insert(emergency_sentence(code));
  }
  EXPECT_EQ(sentences.size(), 18u);
}

TEST(CanopenWords, OnlyZeroMeansThatTheErrorsAreGone) {
  const std::string gone = emergency_sentence(0);
  EXPECT_NE(gone.find("gone"), std::string::npos);
  for (std::uint32_t code = 1; code <= 0xFFFF; ++code)
    ASSERT_NE(emergency_sentence(static_cast<std::uint16_t>(code)), gone) << code;
}

TEST(CanopenWords, SentencesEndAndNameNoCode) {
  for (const auto& table : {emergency_words(), sdo_abort_words()}) {
    for (const CanopenWords& one : table) {
      const std::string sentence = one.sentence;
      EXPECT_TRUE(sentence.back() == '.' || sentence.back() == '?') << sentence;
      EXPECT_EQ(sentence.find("0x"), std::string::npos) << sentence;
    }
  }
}

}  // namespace tact::hal::cia402::canopen_words_test
