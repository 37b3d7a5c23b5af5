#include "host/live_session.h"

#include <gtest/gtest.h>

namespace tact::host {
namespace {

TEST(LiveSession, TakesAHandTargetFromThePage) {
  double position_m[3] = {};
  double grip_ratio = 0.0;
  ASSERT_TRUE(parse_hand(R"({"hand":{"x_m":0.01,"y_m":-0.02,"z_m":0.03,"grip_ratio":1}})",
                         position_m, grip_ratio));
  EXPECT_EQ(position_m[0], 0.01);
  EXPECT_EQ(position_m[1], -0.02);
  EXPECT_EQ(position_m[2], 0.03);
  EXPECT_EQ(grip_ratio, 1.0);
}

TEST(LiveSession, KeepsTheGripBetweenOpenAndClosed) {
  double position_m[3] = {};
  double grip_ratio = 0.5;
  ASSERT_TRUE(parse_hand(R"({"hand":{"x_m":0,"y_m":0,"z_m":0,"grip_ratio":-0.5}})", position_m,
                         grip_ratio));
  EXPECT_EQ(grip_ratio, 0.0);
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
    double position_m[3] = {};
    double grip_ratio = 0.0;
    EXPECT_FALSE(parse_hand(text, position_m, grip_ratio)) << text;
  }
}

}  // namespace
}  // namespace tact::host
