// SPDX-License-Identifier: Apache-2.0
#include "host/server/live_session.h"

#include <gtest/gtest.h>

namespace tact::host::server::live_session_test {

TEST(LiveSession, TakesAHandTargetFromThePage) {
  const auto hand = parse_hand(
      R"({"hand":{"x_m":0.01,"y_m":-0.02,"z_m":0.03,"turn_x_rad":0.1,"turn_y_rad":0.2,"turn_z_rad":-0.3,"grip_ratio":1}})");
  ASSERT_TRUE(hand);
  EXPECT_EQ(hand->position_m[0], 0.01);
  EXPECT_EQ(hand->position_m[1], -0.02);
  EXPECT_EQ(hand->position_m[2], 0.03);
  EXPECT_EQ(hand->rotation_rad[0], 0.1);
  EXPECT_EQ(hand->rotation_rad[1], 0.2);
  EXPECT_EQ(hand->rotation_rad[2], -0.3);
  EXPECT_EQ(hand->grip_ratio, 1.0);
}

TEST(LiveSession, KeepsTheGripBetweenOpenAndClosed) {
  const auto hand = parse_hand(
      R"({"hand":{"x_m":0,"y_m":0,"z_m":0,"turn_x_rad":0.1,"turn_y_rad":0.2,"turn_z_rad":-0.3,"grip_ratio":-0.5}})");
  ASSERT_TRUE(hand);
  EXPECT_EQ(hand->grip_ratio, 0.0);
}

TEST(LiveSession, TakesOneDigitAsAKeyAndNothingElse) {
  EXPECT_EQ(parse_digit(R"({"key":"1"})"), '1');
  for (const char* text : {R"({"key":"12"})", R"({"key":"a"})", R"({"key":1})", R"({"key":""})",
                           R"({"key":"1\n"})", R"(["key"])", R"({})", "1", ""})
    EXPECT_FALSE(parse_digit(text)) << text;
}

TEST(LiveSession, MalformedHandTargetIsRefused) {
  for (const char* text :
       {"", "{", "[]", "null", "7", R"({"hand":7})", R"({"hand":{}})", R"({"hand":[0,0,0,0]})",
        R"({"hand":{"x_m":0,"y_m":0,"z_m":0,"grip_ratio":0}})", R"({"force_N":[1,2,3]})"})
    EXPECT_FALSE(parse_hand(text)) << text;
  const auto parses = [](const std::string& x_m, const std::string& turn_x_rad, const char* rest) {
    return parse_hand("{\"hand\":{\"x_m\":" + x_m + ",\"y_m\":0,\"z_m\":0,\"turn_x_rad\":" +
                      turn_x_rad + ",\"turn_y_rad\":0,\"turn_z_rad\":0" + rest + "}}")
        .has_value();
  };
  constexpr const char* kGrip = ",\"grip_ratio\":0";
  EXPECT_TRUE(parses("0", "0", kGrip));
  EXPECT_FALSE(parses("0", "0", ""));
  for (const char* bad : {"\"0\"", "null", "1e99", "NaN", "3.2"}) {
    EXPECT_FALSE(parses(bad, "0", kGrip)) << bad;
    EXPECT_FALSE(parses("0", bad, kGrip)) << bad;
  }
  EXPECT_FALSE(parses("1.5", "0", kGrip));
}

}  // namespace tact::host::server::live_session_test
