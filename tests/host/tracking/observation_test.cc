// SPDX-License-Identifier: Apache-2.0
#include "host/tracking/observation.h"

#include <gtest/gtest.h>

#include "tests/support/message.h"
#include "tests/support/tracking_views.h"

namespace tact::host::tracking::observation_test {

using tests::message_of;

const std::string kGood =
    R"({"time_s": 12.0333, "sequence": 361, "camera": "front", "body": "head", "points": [[0, 1.5, -2], [7, 3, 4e2]]})";

std::string with(const std::string& from, const std::string& to) {
  std::string out = kGood;
  const std::size_t at = out.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return out.replace(at, from.size(), to);
}

TEST(Observation, IsReadAsTheFormatSays) {
  const model::Result<Observation> read = parse_observation(kGood);
  ASSERT_EQ(message_of(read), "");
  const Observation& seen = *read;
  EXPECT_EQ(seen.time_s, 12.0333);
  EXPECT_EQ(seen.sequence, 361u);
  EXPECT_EQ(seen.camera, "front");
  EXPECT_EQ(seen.body, "head");
  ASSERT_EQ(seen.points.size(), 2u);
  EXPECT_EQ(seen.points[0].id, 0u);
  EXPECT_EQ(seen.points[0].pixel_px, Eigen::Vector2d(1.5, -2.0));
  EXPECT_EQ(seen.points[1].id, 7u);
  EXPECT_EQ(seen.points[1].pixel_px, Eigen::Vector2d(3.0, 400.0));
}

TEST(Observation, KeysThatAreNotKnownArePassedOver) {
  const auto seen = parse_observation(with("\"body\"", "\"gain\": [1, {}], \"body\""));
  ASSERT_EQ(message_of(seen), "");
  EXPECT_EQ(seen->points.size(), 2u);
}

TEST(Observation, OneMessageSaysWhatIsWrong) {
  const std::pair<std::string, const char*> cases[] = {
      {"", "no JSON object"},
      {"[]", "no JSON object"},
      {kGood.substr(0, 60), "no JSON object"},
      {kGood + kGood, "no JSON object"},
      {with("12.0333", "\"12\""), "time_s"},
      {with("12.0333", "1e999"), "no JSON object"},  // JSON knows no infinity
      {with("12.0333", "1e10"), "time_s"},
      {with("361", "-1"), "sequence"},
      {with("361", "1.5"), "sequence"},
      {with("\"front\"", "\"\""), "camera"},
      {with("\"front\"", "7"), "camera"},
      {with("\"head\"", "\"he\\nad\""), "body"},
      {with("\"head\"", "\"" + std::string(33, 'a') + "\""), "body"},
      {with("\"points\"", "\"dots\""), "points"},
      {with("[0, 1.5, -2]", "[0, 1.5]"), "point 0"},
      {with("[0, 1.5, -2]", "[-1, 1.5, 2]"), "point 0"},
      {with("[0, 1.5, -2]", "[0.5, 1.5, 2]"), "point 0"},
      {with("[0, 1.5, -2]", "[4294967296, 1.5, 2]"), "point 0"},
      {with("4e2", "null"), "point 1"},
      {with("4e2", "1e7"), "point 1"},
      {with("[7, 3", "[0, 3"), "marker 0 is there twice"},
      {with("-2]", "-2" + std::string(9000, ' ') + "]"), "bytes"},
  };
  for (const auto& [text, expected] : cases) {
    const std::string wrong = message_of(parse_observation(text));
    EXPECT_NE(wrong.find(expected), std::string::npos) << text << " -> " << wrong;
    EXPECT_EQ(wrong.find('\n'), std::string::npos);
  }
}

TEST(Observation, HasAtMostSixtyFourPoints) {
  for (const std::size_t count : {kMaxMarkers, kMaxMarkers + 1}) {
    Observation made{.camera = "front", .body = "head", .points = {}};
    for (std::uint32_t i = 0; i < count; ++i) made.points.push_back({.id = i});
    EXPECT_EQ(parse_observation(test::line_of(made)).has_value(), count == kMaxMarkers);
  }
}

TEST(Observation, EveryCutOfALineIsRefused) {
  for (std::size_t length = 0; length < kGood.size(); ++length)
    EXPECT_FALSE(parse_observation(kGood.substr(0, length))) << length;
}

TEST(Observation, DeepNestingDoesNoHarm) {
  EXPECT_FALSE(parse_observation(std::string(8000, '[')));
}

}  // namespace tact::host::tracking::observation_test
