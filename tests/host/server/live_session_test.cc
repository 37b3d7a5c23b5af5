// SPDX-License-Identifier: Apache-2.0
#include "host/server/live_session.h"

#include <gtest/gtest.h>

namespace tact::host::server::live_session_test {

TEST(LiveSession, TakesAHandTargetFromThePage) {
  const auto hand = parse_hand(R"({"hand":{"x_m":0.01,"y_m":-0.02,"z_m":0.03,"grip_ratio":1}})");
  ASSERT_TRUE(hand);
  EXPECT_EQ(hand->position_m[0], 0.01);
  EXPECT_EQ(hand->position_m[1], -0.02);
  EXPECT_EQ(hand->position_m[2], 0.03);
  EXPECT_EQ(hand->grip_ratio, 1.0);
}

TEST(LiveSession, KeepsTheGripBetweenOpenAndClosed) {
  const auto hand = parse_hand(R"({"hand":{"x_m":0,"y_m":0,"z_m":0,"grip_ratio":-0.5}})");
  ASSERT_TRUE(hand);
  EXPECT_EQ(hand->grip_ratio, 0.0);
}

TEST(LiveSession, RefusesEverythingElse) {
  for (const char* text :
       {"", "{", "[]", "null", "7", R"({"hand":7})", R"({"hand":{}})", R"({"hand":[0,0,0,0]})",
        R"({"hand":{"x_m":0,"y_m":0,"z_m":0}})",
        R"({"hand":{"x_m":"0","y_m":0,"z_m":0,"grip_ratio":0}})",
        R"({"hand":{"x_m":null,"y_m":0,"z_m":0,"grip_ratio":0}})",
        R"({"hand":{"x_m":1e99,"y_m":0,"z_m":0,"grip_ratio":0}})",
        R"({"hand":{"x_m":NaN,"y_m":0,"z_m":0,"grip_ratio":0}})",
        R"({"hand":{"x_m":1.5,"y_m":0,"z_m":0,"grip_ratio":0}})", R"({"force_N":[1,2,3]})"}) {
    EXPECT_FALSE(parse_hand(text)) << text;
  }
}

}  // namespace tact::host::server::live_session_test
