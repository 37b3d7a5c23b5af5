// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "firmware/console/operator_view.h"

namespace tact::firmware::console::status_line_test {

TEST(StatusLine, ShowsRateLateTicksForceAndState) {
  protocol::Frame before, now;
  before.tick = 1000, before.time_ns = 1'000'000'000;
  now.tick = 1190, now.time_ns = 1'200'000'000;  // ten ticks were skipped
  now.late_ticks = 3, now.skipped_ticks = 10;
  now.force_N[0] = 0.3f, now.force_N[2] = 0.4f;
  now.state = loop::State::kArmed;
  const std::string line = status_line(now, before);
  EXPECT_NE(line.find(" 950 Hz"), std::string::npos) << line;
  EXPECT_NE(line.find("late 3"), std::string::npos) << line;
  EXPECT_NE(line.find("0.500 N"), std::string::npos) << line;
  EXPECT_NE(line.find("armed"), std::string::npos) << line;
}

TEST(StatusLine, SaysBeyondTheLaw) {
  protocol::Frame frame;
  frame.limit = static_cast<std::uint16_t>(model::Fault::kLawSaturated);
  EXPECT_NE(status_line(frame, frame).find("beyond the law"), std::string::npos);
}

TEST(StatusLine, SaysInsideTheOrgan) {
  protocol::Frame frame;
  frame.limit = static_cast<std::uint16_t>(model::Fault::kToolInside);
  EXPECT_NE(status_line(frame, frame).find("inside the organ"), std::string::npos);
}

TEST(StatusLine, CountsLossesOfContactOnceThereIsOne) {
  protocol::Frame frame;
  EXPECT_EQ(status_line(frame, frame).find("contact lost"), std::string::npos);
  frame.contact_losses = 2;
  EXPECT_NE(status_line(frame, frame).find("contact lost 2"), std::string::npos);
}

TEST(StatusLine, NamesTheFaultBeforeTheLimit) {
  protocol::Frame frame;
  frame.limit = 7;
  EXPECT_NE(status_line(frame, frame).find("slew limited"), std::string::npos);
  frame.fault = 103;
  EXPECT_NE(status_line(frame, frame).find("device lost"), std::string::npos);
}

}  // namespace tact::firmware::console::status_line_test
