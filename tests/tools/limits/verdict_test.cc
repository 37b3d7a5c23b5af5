// SPDX-License-Identifier: Apache-2.0
// What tact-limits evaluates by, on rows written by hand.
#include "tools/limits/verdict/verdict.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "tools/limits/report/report.h"

namespace tact::tools::limits::verdict_test {

using model::Limits;

// Three ticks by hand: 2 N held while the tool moves 3 mm along it, then let go.
std::vector<TickRow> three_ticks() {
  std::vector<TickRow> rows(3);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].t_s = 0.001 * static_cast<double>(i);
    rows[i].fresh = rows[i].armed = true;
    rows[i].tool.position_m = {0, 0, 0.003 * static_cast<double>(i)};
  }
  rows[0].written_N = rows[0].gated_N = {0, 0, 2.0};
  rows[1].written_N = rows[1].gated_N = {0, 0, 1.0};
  return rows;
}
constexpr Limits kLimits{.force_N = 2.0,
                         .torque_Nm = 0.1,
                         .slew_N_per_s = 2000.0,
                         .ramp_s = 0.1,
                         .workspace_radius_m = 0.1,
                         .workspace_half_length_m = 0.1,
                         .energy_J = 0.01};

bool holds(const std::vector<TickRow>& rows, const std::string& words, Limits limits = kLimits) {
  for (const Check& c : check_rows({}, rows, limits, 0.001).checks)
    if (c.message.find(words) != std::string::npos) return c.holds;
  ADD_FAILURE() << "no check says " << words;
  return false;
}

TEST(Verdict, MatchesPenAndPaper) {
  const Extremes worst = extremes_of(three_ticks(), kLimits, 0.001);
  EXPECT_DOUBLE_EQ(worst.given_energy_J, 2.0 * 0.003 + 1.0 * 0.003);
  EXPECT_DOUBLE_EQ(worst.force_N, 2.0);
  EXPECT_DOUBLE_EQ(worst.step_N, 2.0);
  EXPECT_EQ(worst.overdrawn_J, 0.0);
  Limits less = kLimits;
  less.energy_J = 0.008;
  less.recovery_W = 0.0;
  EXPECT_FALSE(holds(three_ticks(), "energy given", less));
  EXPECT_TRUE(holds(three_ticks(), "energy given"));
}

TEST(Verdict, AMissedSampleCountsTheMeanForceAlongTheWholeWay) {
  std::vector<TickRow> rows = three_ticks();
  rows[1].fresh = false;
  EXPECT_DOUBLE_EQ(extremes_of(rows, kLimits, 0.001).given_energy_J, 1.5 * 0.006);
}

TEST(Verdict, SeesAForceThatTheGateDidNotLetThrough) {
  std::vector<TickRow> rows = three_ticks();
  EXPECT_TRUE(holds(rows, "bit for bit"));
  rows[1].written_N.x = 1e-12;
  EXPECT_FALSE(holds(rows, "bit for bit"));
}

TEST(Verdict, SeesAForceThatIsNotArmedOrAfterAFault) {
  std::vector<TickRow> rows = three_ticks();
  EXPECT_TRUE(holds(rows, "while it was not armed"));
  rows[1].armed = false;
  EXPECT_FALSE(holds(rows, "while it was not armed"));
  rows = three_ticks();
  rows[0].fault = Fault::kEmergencyStop;
  EXPECT_FALSE(holds(rows, "from a latched fault on"));
}

TEST(Verdict, CountsFromTheCauseToZero) {
  std::vector<TickRow> rows = three_ticks();
  EXPECT_FALSE(extremes_of(rows, kLimits, 0.001).zero_s) << "no cause";
  rows[1].cause = true;
  EXPECT_DOUBLE_EQ(*extremes_of(rows, kLimits, 0.001).zero_s, 0.001);
}

// The last tick of three has no force, so by hand: zero 2 ms after a cause at the first.
TEST(Verdict, SeesAForceThatComesBackWhileItsCauseLasts) {
  std::vector<TickRow> rows = three_ticks();
  rows.push_back(rows[2]);
  rows[3].t_s = 0.003;
  for (TickRow& row : rows) row.cause = true;
  EXPECT_DOUBLE_EQ(*extremes_of(rows, kLimits, 0.001).zero_s, 0.002);
  rows[3].written_N.z = 1.0;
  EXPECT_FALSE(extremes_of(rows, kLimits, 0.001).zero_s) << "the last tick pushes again";
  rows.push_back(rows[2]);
  rows[4].t_s = 0.004;
  EXPECT_DOUBLE_EQ(*extremes_of(rows, kLimits, 0.001).zero_s, 0.004) << "the last zero counts";
  rows[3].cause = false;
  EXPECT_DOUBLE_EQ(*extremes_of(rows, kLimits, 0.001).zero_s, 0.002) << "the cause is gone";
}

TEST(Verdict, SeesATorqueThatStaysWhenTheForceHasGone) {
  std::vector<TickRow> rows = three_ticks();
  for (TickRow& row : rows) row.cause = true;
  rows[2].written_Nm = {0, 0.01, 0};
  EXPECT_FALSE(extremes_of(rows, kLimits, 0.001).zero_s);
  Case estop = all_cases().front();
  estop.expected = {.zero_within_s = 0.002};
  estop.grip = Grip::kLever;
  const auto says = [&](const char* words) {
    for (const Check& c : check_rows(estop, rows, kLimits, 0.001).checks)
      if (c.message.find(words) != std::string::npos) return c.holds;
    ADD_FAILURE() << "no check says " << words;
    return false;
  };
  EXPECT_FALSE(says("came to zero"));
  EXPECT_FALSE(says("the test had torque")) << "a tenth of its limit is none";
  rows[1].written_Nm = {0, 0.05, 0};
  rows[2].written_Nm = {};
  EXPECT_TRUE(says("zero 2 ms after the cause"));
  EXPECT_TRUE(says("the test had torque"));
}

TEST(Verdict, PowerIsThatOfForceAndTorqueInTheTraceAsInTheVerdict) {
  TickRow row;
  row.written_N = {0, 0, 2.0};
  row.tool.velocity_mps = {0, 0, 0.5};
  row.written_Nm = {0.1, 0, 0};
  row.tool.angular_velocity_radps = {3.0, 0, 0};
  row.gated_Nm = {0.07, 0, 0};
  EXPECT_DOUBLE_EQ(model::given_power_W({row.written_N, row.written_Nm}, row.tool), 1.3);
  EXPECT_DOUBLE_EQ(extremes_of({row}, kLimits, 0.001).power_W, 1.3);
  const std::string folder = testing::TempDir() + "tact-verdict-" + std::to_string(getpid());
  std::filesystem::create_directories(folder);
  LimitsReport report;
  CaseResult ramp;
  ramp.verdict.subject = all_cases().front();
  ramp.rows = {row};
  report.cases.push_back(ramp);
  ASSERT_FALSE(write_report(report, folder));
  std::ifstream trace(folder + "/trace_ramp.csv");
  std::string head, line, name, value;
  std::getline(trace, head);
  std::getline(trace, line);
  std::istringstream names(head), values(line);
  std::map<std::string, std::string> cells;
  while (std::getline(names, name, ',') && std::getline(values, value, ',')) cells[name] = value;
  EXPECT_EQ(cells["power_W"], "1.3");
  EXPECT_EQ(cells["gated_Nm"], "0.07");
  EXPECT_EQ(cells["written_Nm"], "0.1");
  std::filesystem::remove_all(folder);
}

}  // namespace tact::tools::limits::verdict_test
