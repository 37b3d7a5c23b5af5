// SPDX-License-Identifier: Apache-2.0
// A run's report is written for any name of its device.
#include "firmware/run/report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace tact::firmware::run::report_test {

TEST(Report, IsJsonForAnyBytesInADevicesName) {
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

TEST(Report, ReportsTheLargestTorqueWhereThereWasOne) {
  const gate::Gate gate(model::Limits{.force_N = 1.0, .slew_N_per_s = 500.0, .ramp_s = 0.5}, 1e-3,
                        1.0);
  loop::LoopStatistics loop;
  EXPECT_EQ(make_summary(RunFacts{}, loop).find("torque"), std::string::npos);
  loop.max_torque_Nm = 0.0279;
  const auto report = nlohmann::json::parse(make_report(RunFacts{}, loop, gate, pc::Environment{}));
  EXPECT_EQ(report.at("torque_max_Nm"), 0.0279);
  EXPECT_NE(make_summary(RunFacts{}, loop).find(", torque max 27.9 mN m"), std::string::npos);
}

TEST(Report, ReportsLossesOfContactTicksInsideTheOrganAndClutches) {
  const gate::Gate gate(model::Limits{.force_N = 1.0, .slew_N_per_s = 500.0, .ramp_s = 0.5}, 1e-3,
                        1.0);
  loop::LoopStatistics loop;
  loop.ticks = 1000;
  const std::string without = make_summary(RunFacts{}, loop);
  EXPECT_EQ(without.find("contact lost"), std::string::npos) << without;
  EXPECT_EQ(without.find("inside the organ"), std::string::npos) << without;
  EXPECT_EQ(without.find("clutch"), std::string::npos) << without;
  loop.contact_losses = 3;
  loop.inside_ticks = 40;
  loop.clutches = 2;
  const auto report = nlohmann::json::parse(make_report(RunFacts{}, loop, gate, pc::Environment{}));
  EXPECT_EQ(report.at("contact_lost"), 3);
  EXPECT_EQ(report.at("inside_ticks"), 40);
  EXPECT_EQ(report.at("clutches"), 2);
  const std::string summary = make_summary(RunFacts{}, loop);
  EXPECT_NE(summary.find("the clutch opened 2 times"), std::string::npos) << summary;
  EXPECT_NE(summary.find("contact lost 3 times: the tool moved too far between two samples"),
            std::string::npos);
  EXPECT_NE(summary.find("inside the organ, without force, in 40 of 1000"), std::string::npos);
}

}  // namespace tact::firmware::run::report_test
