// SPDX-License-Identifier: Apache-2.0
#include "tools/jitter/report/jitter_report.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/program.h"
#include "tools/program/run_program.h"

namespace tact::tools::jitter::jitter_report_test {

namespace fs = std::filesystem;
using nlohmann::json;
using tests::run_program;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string read_file(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// Ticks of 5.2 and 5.4 us wake-up, the last of them of 2 ms.
JitterResult small_result(std::uint64_t ticks) {
  JitterResult result;
  result.subject = "bare <loop> & 'friends'";
  result.rate_Hz = 1000.0;
  result.measured_s = 1e-3 * static_cast<double>(ticks);
  result.non_rt = true;
  result.sink = std::make_unique<TickSink>(SinkSettings{});
  for (std::uint64_t i = 0; i < ticks; ++i) {
    firmware::loop::TickRecord record;
    record.tick = i;
    record.due_ns = 1'000'000'000 + static_cast<std::int64_t>(i) * 1'000'000;
    record.phase_ns = {i + 1 == ticks ? 2'000'000 : i % 2 == 0 ? 5'200 : 5'400,
                       100,
                       200,
                       300,
                       400,
                       500,
                       600,
                       2'100};
    result.sink->add(record);
  }
  result.pc = {{.name = "kernel",
                .verdict = firmware::pc::Verdict::kRed,
                .found = "stock",
                .why = "late",
                .remedy = "boot another"}};
  return result;
}

TEST(Report, APercentileWithNoSampleBeyondItIsNotReported) {
  const JitterResult result = small_result(1000);
  const auto& wake = result.sink->phase(firmware::loop::Phase::kWake).histogram;
  EXPECT_EQ(percentile_ns(wake, 0.999), wake.percentile_ns(0.999));
  EXPECT_LT(*percentile_ns(wake, 0.999), 6'000u) << "999 of 1000 took 5.4 us at most";
  EXPECT_FALSE(percentile_ns(wake, 0.9999));
  EXPECT_EQ(to_json(result, "c")["series"]["wake"]["p99.99_ns"], nullptr);
  EXPECT_FALSE(percentile_ns(firmware::loop::LatencyHistogram{}, 0.5));
}

TEST(Report, TheLargestHasItsTickAndTimeAndBoundsNothing) {
  const JitterResult result = small_result(1000);
  const json wake = to_json(result, "c")["series"]["wake"];
  EXPECT_EQ(wake["samples"], 1000);
  EXPECT_EQ(wake["max_ns"], 2'000'000);
  EXPECT_EQ(wake["max_tick"], 999);
  EXPECT_NEAR(wake["max_at_s"].get<double>(), 0.999, 1e-9);
  std::uint64_t samples = 0;
  for (const auto& bucket : wake["buckets_ns"]) {
    EXPECT_LE(bucket[0], bucket[1]);
    samples += bucket[2].get<std::uint64_t>();
  }
  EXPECT_EQ(samples, 1000u);
  const std::string text = make_summary(result);
  EXPECT_TRUE(has(text, "1000 ticks"));
  EXPECT_TRUE(has(text, "bounds nothing"));
  EXPECT_FALSE(has(text, "worst case"));
}

TEST(Report, TheRatioToThePeerNeedsSamplesOfBoth) {
  JitterResult result = small_result(1000);
  EXPECT_FALSE(ratio_to_peer(result));
  result.peer.emplace();
  EXPECT_FALSE(ratio_to_peer(result));
  for (std::uint64_t i = 0; i < 1000; ++i) result.peer->record(2'700, i, 0);
  EXPECT_NEAR(*ratio_to_peer(result), 2.0, 2.0 / 32);
}

TEST(Report, OneStallMovesTheRatioOfARunButNotTheMiddleOfItsTurns) {
  JitterResult result = small_result(1000);
  result.peer.emplace();
  for (std::uint64_t i = 0; i < 1000; ++i) result.peer->record(2'700, i, 0);
  EXPECT_EQ(to_json(result, "c")["wake_p99.9_over_peer_by_turn"], nullptr);
  result.turn_ratios = {1.1, 0.9};
  EXPECT_FALSE(has(make_summary(result), "turn by turn")) << "two turns have no middle";
  result.turn_ratios = {1.1, 40.0, 0.9, 1.0, 1.2};
  const json reported = to_json(result, "c")["wake_p99.9_over_peer_by_turn"];
  EXPECT_EQ(reported["turns"], 5);
  EXPECT_EQ(reported["lower_quartile"], 1.0);
  EXPECT_EQ(reported["median"], 1.1);
  EXPECT_EQ(reported["upper_quartile"], 1.2);
  EXPECT_TRUE(has(make_summary(result), "turn by turn 1.10 in the median of 5"));
  EXPECT_TRUE(has(to_json(result, "c")["compared_with_peer"].get<std::string>(),
                  "turn by turn 1.10 in the median of 5"));
}

json result_with(std::uint64_t p99_ns) {
  return {{"format", "tact-jitter"},
          {"version", 2},
          {"rate_Hz", 1000},
          {"series",
           {{"wake",
             {{"p50_ns", 5000}, {"p99_ns", p99_ns}, {"p99.9_ns", nullptr}, {"max_ns", p99_ns * 9}}},
            {"read", {{"p99_ns", p99_ns}}}}}};
}

class Folder : public testing::Test {
 protected:
  program::ScratchFolder scratch = std::move(*program::ScratchFolder::make("tact-jitter-test"));
};

using JitterProgram = Folder;

TEST_F(JitterProgram, WritesAReportOfARealLoopThatComparesWithItself) {
  const std::string out = scratch.file("run");
  const auto run = run_program("tact-jitter", std::string(TACT_SOURCE_DIR) +
                                                  "/model/scenes/liver.toml --duration 0.3 --rate "
                                                  "800 --out " +
                                                  out);
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_TRUE(has(run.output, "at 800 Hz")) << run.output;
  const json result = json::parse(read_file(out + "/jitter.json"));
  EXPECT_EQ(result["ticks"].get<int>() + result["skipped"].get<int>(), 240);
  EXPECT_EQ(result["series"]["every_wake"]["samples"], 240);
  EXPECT_EQ(result["series"]["render"]["samples"], result["ticks"]);
  EXPECT_TRUE(result["thread"]["allocations"] == 0 || result["thread"]["allocations"].is_null());
  EXPECT_GE(result["pc"].size(), 15u);
  EXPECT_FALSE(result["environment"]["kernel_release"].get<std::string>().empty());
  const std::string page = read_file(out + "/report.html");
  EXPECT_TRUE(has(page, "<svg"));
  EXPECT_TRUE(has(page, "</b> on <b>" + result["host"].get<std::string>()));
  EXPECT_GT(fs::file_size(out + "/ticks.trace.json"), 1000u);
  const std::string itself = out + "/jitter.json " + out + "/jitter.json";
  EXPECT_EQ(run_program("tact-jitter", "compare " + itself + " --gate 1").status, 0);
}

TEST_F(JitterProgram, ComparesWithAnExitStatusForAGate) {
  std::ofstream(scratch.file("a.json")) << result_with(20'000);
  std::ofstream(scratch.file("b.json")) << result_with(30'000);
  const std::string files = "compare " + scratch.file("a.json") + " " + scratch.file("b.json");
  EXPECT_EQ(run_program("tact-jitter", files).status, 0) << "without a gate it only shows";
  const auto worse = run_program("tact-jitter", files + " --gate 10");
  EXPECT_EQ(worse.status, 1);
  EXPECT_TRUE(has(worse.output, "WORSE")) << worse.output;
  EXPECT_EQ(run_program("tact-jitter", files + " --gate 60").status, 0);
  std::ofstream(scratch.file("c.json")) << "{}";
  const auto none = run_program("tact-jitter",
                                "compare " + scratch.file("a.json") + " " + scratch.file("c.json"));
  EXPECT_EQ(none.status, 2);
  EXPECT_TRUE(has(none.output, "c.json: is no result")) << none.output;
}

TEST_F(JitterProgram, MeasuresUnderLoadInTurnsWithCyclictest) {
  const auto run = run_program("tact-jitter", std::string(TACT_SOURCE_DIR) +
                                                  "/model/scenes/liver.toml --duration 0.4 --load "
                                                  "cpu --peer cyclictest --json - 2>/dev/null");
  ASSERT_EQ(run.status, 0) << run.output;
  const json result = json::parse(run.output);
  EXPECT_EQ(result["load"], "cpu");
  EXPECT_EQ(result["fault"], "") << "the pause between two slices is none";
  // At most 400: what a busy PC skips after the last tick of a slice is in no tick.
  EXPECT_NEAR(result["ticks"].get<int>() + result["skipped"].get<int>(), 300, 100);
  EXPECT_NEAR(result["series"]["peer_wake"]["samples"].get<int>(), 300, 100);
}

TEST_F(JitterProgram, ABareLoopHasNoForce) {
  const auto run = run_program("tact-jitter", "--bare --duration 0.2 --json -");
  ASSERT_EQ(run.status, 0) << run.output;
  const json result = json::parse(run.output);
  EXPECT_EQ(result["series"]["every_wake"]["samples"], 200);
  EXPECT_FALSE(result["series"].contains("render"));
  EXPECT_FALSE(result["series"].contains("deadline_to_force"));
}

TEST_F(JitterProgram, CtrlCEndsItAtOnceAndKeepsWhatWasMeasured) {
  const auto begun = std::chrono::steady_clock::now();
  const auto run =
      run_program("tact-jitter", "--bare --duration 60 --json " + scratch.file("j") +
                                     " 2>&1 & pid=$!; sleep 0.7; kill -INT $pid; wait $pid");
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(30));
  EXPECT_EQ(run.status, 1) << run.output;
  EXPECT_TRUE(has(run.output, "tact-jitter: interrupted; what was measured")) << run.output;
  const json result = json::parse(read_file(scratch.file("j")));
  EXPECT_EQ(result["interrupted"], true);
  EXPECT_LT(result["series"]["every_wake"]["samples"], 30'000);
}

TEST_F(JitterProgram, RefusesBadUsageWithARemedy) {
  for (const char* arguments : {"--bare x.toml", "--bare --load noise", "--bare --rate 5",
                                "compare a.json", "nosuch.toml", "--bare --out /proc/x"}) {
    const auto run = run_program("tact-jitter", arguments);
    EXPECT_EQ(run.status, 2) << arguments << ": " << run.output;
    EXPECT_TRUE(run.output.starts_with("tact-jitter") || has(run.output, "nosuch.toml") ||
                has(run.output, "tact-jitter compare: error"))
        << run.output;
  }
}

TEST_F(Folder, DoctorReportsItsRowsAsTextAndJsonWithAnExitStatus) {
  const auto text = run_program("tact-doctor", "");
  const auto machine = run_program("tact-doctor", "--json");
  const json checks = json::parse(machine.output)["checks"];
  bool any_red = false;
  for (const auto& row : checks) {
    any_red |= row["verdict"] == "red";
    EXPECT_TRUE(has(text.output, row["name"].get<std::string>())) << row["name"];
    if (row["verdict"] == "red")
      EXPECT_TRUE(has(text.output, "remedy: " + row["remedy"].get<std::string>())) << row["name"];
  }
  EXPECT_EQ(machine.status, any_red ? 1 : 0);
  EXPECT_FALSE(has(text.output, "\033")) << "no colours in a pipe";
  EXPECT_EQ(run_program("tact-doctor", "--root " + scratch.path()).status, 2);
  fs::create_directories(scratch.file("proc"));
  EXPECT_EQ(run_program("tact-doctor", "--root " + scratch.path()).status, 1);
}

}  // namespace tact::tools::jitter::jitter_report_test
