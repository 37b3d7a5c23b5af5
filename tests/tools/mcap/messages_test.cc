// SPDX-License-Identifier: Apache-2.0
#include "tools/mcap/messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

namespace tact::tools::mcap::messages_test {

double number_at(const std::string& bytes, std::size_t at) {
  double value = 0.0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Of a time of 3 s and 5 ns: CDR little-endian, the stamp, the name with its zero byte.
const std::string kHead("\0\x01\0\0\x03\0\0\0\x05\0\0\0\x0c\0\0\0tact_device\0", 28);
constexpr std::size_t kNumbers = 28;  // 24 behind the encapsulation: on 8 already

TEST(Messages, ANumberStandsOnAMultipleOfItsSizeBehindTheEncapsulation) {
  const std::string bytes =
      Cdr().put(std::uint8_t{1}).put(std::uint16_t{2}).put(std::uint8_t{3}).real(1.0).str();
  EXPECT_EQ(bytes, std::string("\0\x01\0\0\x01\0\x02\0\x03\0\0\0\0\0\0\xf0\x3f", 4 + 4 + 1)
                       .append(3, '\0')
                       .append("\0\0\0\0\0\0\xf0\x3f", 8));
}

TEST(Messages, APoseHasItsRealPartLast) {
  const Moment moment{.time_ns = 3'000'000'005,
                      .position_m = {1.0, 2.0, 3.0},
                      .rotation_wxyz = {0.1, 0.2, 0.3, 0.4},
                      .written = {},
                      .wanted = {}};
  const std::string bytes = pose_message(moment);
  ASSERT_EQ(bytes.size(), kNumbers + 7 * 8);
  EXPECT_EQ(bytes.substr(0, kNumbers), kHead);
  const double expected[] = {1.0, 2.0, 3.0, 0.2, 0.3, 0.4, 0.1};
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(number_at(bytes, kNumbers + 8 * i), expected[i]);
}

TEST(Messages, OfATickEachVectorHasItsOwnPlace) {
  firmware::telemetry::LoggedTick tick;
  tick.output.written = {.force_N = {1.0, 2.0, 3.0}, .torque_Nm = {4.0, 5.0, 6.0}};
  tick.output.wanted = {.force_N = {7.0, 8.0, 9.0}, .torque_Nm = {10.0, 11.0, 12.0}};
  const Moment moment = Moment::of(tick, 3'000'000'005);
  const std::string written = wrench_message(moment, moment.written);
  const std::string wanted = wrench_message(moment, moment.wanted);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(number_at(written, kNumbers + 8 * i), 1.0 + static_cast<double>(i));
    EXPECT_EQ(number_at(wanted, kNumbers + 8 * i), 7.0 + static_cast<double>(i));
  }
}

TEST(Messages, AFrameHasNoWantedTorque) {
  firmware::telemetry::Frame frame;
  frame.wanted_force_N[2] = 1.5f;
  const Moment moment = Moment::of(frame, 3'000'000'005);
  const std::string bytes = wrench_message(moment, moment.wanted);
  ASSERT_EQ(bytes.size(), kNumbers + 6 * 8);
  EXPECT_EQ(number_at(bytes, kNumbers + 16), 1.5);
  EXPECT_TRUE(std::isnan(number_at(bytes, kNumbers + 24)));
}

TEST(Messages, ATimeBeyondTheStampStaysAtItsEnd) {
  const std::string bytes = state_message({.time_ns = UINT64_MAX, .written = {}, .wanted = {}});
  EXPECT_EQ(bytes.substr(4, 4), "\xff\xff\xff\x7f");
}

}  // namespace tact::tools::mcap::messages_test
