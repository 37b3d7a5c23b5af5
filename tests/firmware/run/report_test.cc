// SPDX-License-Identifier: Apache-2.0
// A run's report is written whatever its device is called.
#include "firmware/run/report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace tact::firmware::run::report_test {

TEST(Report, IsJsonWhateverBytesADeviceHasForItsName) {
  model::Limits limits;
  limits.force_N = 1.0;
  limits.slew_N_per_s = 500.0;
  limits.ramp_s = 0.5;
  const gate::Gate gate(limits, 1e-3, 1.0);
  RunFacts facts;
  facts.device_name = "Touch \xff\xfe";
  const std::string text = make_report(facts, loop::LoopStatistics{}, gate, pc::Environment{});
  const auto report = nlohmann::json::parse(text, nullptr, false);
  ASSERT_FALSE(report.is_discarded()) << text;
  EXPECT_EQ(report.at("device"), "Touch \uFFFD\uFFFD");
}

}  // namespace tact::firmware::run::report_test
