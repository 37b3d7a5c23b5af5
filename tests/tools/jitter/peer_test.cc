// SPDX-License-Identifier: Apache-2.0
// cyclictest beside the loop: its samples, its turns, and the ratio that is reported and evaluated.
#include "tools/jitter/run/peer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/support/program.h"
#include "tools/jitter/report/jitter_report.h"

namespace tact::tools::jitter::peer_test {

TEST(Peer, CountsCyclictestsSamplesAtTheUpperEdgeOfTheirMicrosecond) {
  Series series;
  const auto error = add_cyclictest(
      R"({"thread":{"0":{"histogram":{"2":3,"10":6},"cycles":10,"max":60000}}})", 10, series);
  ASSERT_FALSE(error) << error->message;
  EXPECT_EQ(series.histogram.count(), 10u) << "the one beyond the histogram is the largest";
  EXPECT_EQ(series.histogram.percentile_ns(0.3), 2'999u / 32 * 32 + 31);
  EXPECT_EQ(series.histogram.max_ns(), 60'000'999u);
  for (const char* bad : {"", "{}", "[]", R"({"thread":{"0":{"histogram":3}}})", R"({"thread":7})"})
    EXPECT_TRUE(add_cyclictest(bad, 10, series)) << bad;
}

TEST(Peer, RefusesMoreSamplesThanTheCyclesAskedForAndCountsNone) {
  Series series;
  for (const char* samples :
       {R"({"2":11},"cycles":10)", R"({"2":6,"3":5},"cycles":10)", R"({"2":1},"cycles":11)",
        R"({"2":18446744073709551615,"3":2},"cycles":10)",
        R"({"2":1},"cycles":18446744073709551615)"}) {
    const std::string text =
        std::string(R"({"thread":{"0":{"histogram":)") + samples + R"(,"max":4}}})";
    const auto error = add_cyclictest(text, 10, series);
    ASSERT_TRUE(error) << text;
    EXPECT_NE(error->message.find("the 10 cycles"), std::string::npos) << error->message;
  }
  EXPECT_EQ(series.histogram.count(), 0u);
}

TEST(Peer, TakesTurnsInSlicesOfFiveSecondsAtMost) {
  EXPECT_EQ(slices_of(12.0, false), (std::vector<double>{12.0}));
  EXPECT_EQ(slices_of(12.0, true), (std::vector<double>{4.0, 4.0, 4.0}));
  EXPECT_EQ(slices_of(1.0, true).size(), 2u);
  const auto arguments = cyclictest_arguments(
      {.core = 3, .priority = 80, .period_ns = 250'000, .duration_s = 2.0}, "out.json");
  for (const char* word : {"-p80", "-a3", "-i250", "-l8000", "-m"})
    EXPECT_EQ(std::count(arguments.begin(), arguments.end(), word), 1) << word;
}

TEST(Peer, TurnsAddUpToOneSeries) {
  Series first, second;
  for (const std::int64_t ns : {1'000, 2'000, 40'000}) first.record(ns, 7, 70);
  for (const std::int64_t ns : {3'000, 50'123}) second.record(ns, 9, 90);
  first.add(second);
  EXPECT_EQ(first.histogram.count(), 5u);
  EXPECT_EQ(first.histogram.max_ns(), 50'123u);
  EXPECT_EQ(first.histogram.max_tick(), 9u);
  EXPECT_EQ(first.max_at_ns, 90);
  EXPECT_NEAR(static_cast<double>(first.histogram.percentile_ns(0.5)), 3'000.0, 3'000.0 / 64);
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

JitterResult with_peer() {
  JitterResult result;
  result.sink = std::make_unique<TickSink>(SinkSettings{});
  result.peer.emplace();
  return result;
}

TEST(PeerGate, ThePeerGateJudgesTheMiddleOfTheTurns) {
  JitterResult result = with_peer();
  result.turn_ratios = {1.19, 40.0, 1.0};
  EXPECT_EQ(exit_status(result), 0) << "without a gate nothing is judged";
  EXPECT_EQ(to_json(result, "c")["peer_gate"], nullptr);
  result.peer_gate = 1.2;
  EXPECT_EQ(exit_status(result), 0) << "one turn of 40 is a stall of the machine";
  EXPECT_EQ(to_json(result, "c")["peer_gate"]["passed"], true);
  result.turn_ratios = {1.21, 0.1, 0.2, 1.3, 1.4};
  EXPECT_EQ(exit_status(result), 1);
  EXPECT_EQ(to_json(result, "c")["peer_gate"]["passed"], false);
  EXPECT_EQ(to_json(result, "c")["peer_gate"]["most"], 1.2);
  const char* message =
      "FAIL: wake-up p99.9 is 1.21 of cyclictest's in the median of 5 turns, allowed are 1.2";
  EXPECT_TRUE(has(make_summary(result), message)) << make_summary(result);
}

TEST(PeerGate, APeerGateWithoutThreeTurnsIsNeitherPassedNorFailed) {
  JitterResult result = with_peer();
  result.peer_gate = 1.2;
  result.turn_ratios = {1.0, 1.0};
  EXPECT_EQ(exit_status(result), 2);
  EXPECT_EQ(to_json(result, "c")["peer_gate"]["passed"], nullptr);
  EXPECT_TRUE(has(make_summary(result), "could not be judged: fewer than three turns"));
  result.fault = "103 no samples";
  EXPECT_EQ(exit_status(result), 1);
}

TEST(PeerGate, TheReportBeginsWithWhatTheGateFound) {
  JitterResult result = with_peer();
  const auto begins_with = [&](const std::string& verdict, const char* message) {
    const auto report = to_json(result, "c");
    return report["outcome_verdict"] == verdict &&
           report["outcome"].get<std::string>().starts_with(message);
  };
  EXPECT_TRUE(begins_with("part", "NOT JUDGED: no tick was measured"));
  result.peer_gate = 1.2;
  EXPECT_TRUE(begins_with("part", "NOT JUDGED: --peer-gate 1.2 could not"));
  result.turn_ratios = {1.1, 1.1, 1.1};
  EXPECT_TRUE(begins_with("pass", "PASS: "));
  result.turn_ratios = {1.3, 1.3, 1.3};
  EXPECT_TRUE(begins_with("fail", "FAIL: wake-up"));
  result.turn_ratios = {1.1, 1.1, 1.1};
  result.fault = "103 no samples";
  EXPECT_TRUE(begins_with("fail", "FAIL: the run ended with a fault: 103"))
      << "a fault is reported before a gate that passes";
}

TEST(PeerGate, AGateOnThePeerNeedsAPeerAndEnoughTurns) {
  EXPECT_EQ(tests::run_program("tact-jitter", "--bare --duration 0.1 --peer-gate 1.2").status, 2);
  const auto run = tests::run_program(
      "tact-jitter", "--bare --duration 0.2 --peer cyclictest --peer-gate 1.2 --json -");
  EXPECT_EQ(run.status, 2) << run.output;
  EXPECT_TRUE(has(run.output, "tact-jitter: --peer-gate 1.2 could not be judged")) << run.output;
}

}  // namespace tact::tools::jitter::peer_test
