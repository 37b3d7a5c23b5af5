// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>

#include "hal/moteus/moteus_protocol.h"

namespace tact::hal::moteus::moteus_words_test {

TEST(MoteusWords, EveryFaultCodeHasOneMessageAndIsNotALimit) {
  std::set<int> codes;
  for (const MoteusFaultText& one : moteus_fault_texts()) {
    EXPECT_TRUE(codes.insert(one.code).second) << one.code;
    EXPECT_FALSE(is_moteus_limit(one.code));
    const char last = std::string(one.message).back();
    EXPECT_TRUE(last == '.' || last == '?') << one.message;
    const std::string reported = moteus_fault_message(one.code);
    EXPECT_TRUE(reported.starts_with(one.message));
    EXPECT_TRUE(reported.ends_with("(fault " + std::to_string(one.code) + ")"));
  }
  EXPECT_EQ(codes.size(), 18u);  // 32 to 50 but for 45, which needs a command that is never sent
}

TEST(MoteusWords, AFaultThatIsNotKnownIsReportedWithItsNumber) {
  EXPECT_NE(moteus_fault_message(77).find("(fault 77)"), std::string::npos);
}

TEST(MoteusWords, LimitsAreDistinguishedFromFaultsByTheirNumber) {
  EXPECT_FALSE(is_moteus_limit(0));
  EXPECT_FALSE(is_moteus_limit(50));
  EXPECT_TRUE(is_moteus_limit(96));
  EXPECT_TRUE(is_moteus_limit(103));
}

TEST(MoteusWords, ModesHaveNames) {
  EXPECT_STREQ(moteus_mode_name(0), "stopped");
  EXPECT_STREQ(moteus_mode_name(10), "in position mode");
  EXPECT_STREQ(moteus_mode_name(11), "in timeout");
  EXPECT_STREQ(moteus_mode_name(99), "in another mode");
}

}  // namespace tact::hal::moteus::moteus_words_test
