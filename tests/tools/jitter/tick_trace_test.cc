// SPDX-License-Identifier: Apache-2.0
// The trace of tact-jitter: what ui.perfetto.dev is given.
#include "tools/jitter/trace/tick_trace.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "model/io/input_file.h"
#include "tests/support/program.h"
#include "tools/program/run_program.h"

namespace tact::tools::jitter::tick_trace_test {

using firmware::loop::Phase;
using nlohmann::json;

/// Its events by their type: X a slice, C a number, i a moment, M a name.
std::map<std::string, std::vector<json>> events_of(const std::string& text) {
  std::map<std::string, std::vector<json>> out;
  const json trace = json::parse(text);
  EXPECT_EQ(trace["displayTimeUnit"], "ns");
  for (const json& event : trace["traceEvents"]) out[event["ph"]].push_back(event);
  return out;
}

TickTimes tick_at(std::uint64_t tick, std::int64_t due_ns, std::uint32_t skipped = 0) {
  return {.tick = tick,
          .due_ns = due_ns,
          .skipped_before = skipped,
          .phase_ns = {5'000, 300, 200, 100, 150, 80, 60, 5'890}};
}

TEST(TickTrace, PhasesLieInTheirTickOneBehindTheOther) {
  const auto events = events_of(make_tick_trace(
      {tick_at(1, 1'000'000), tick_at(2, 2'000'000), tick_at(5, 5'000'000, 2)}, 1'000));
  // A wake-up, a tick and six phases each.
  EXPECT_EQ(events.at("X").size(), 3u * 8);
  EXPECT_EQ(events.at("C").size(), 3u);
  ASSERT_EQ(events.at("i").size(), 1u) << "the points of the grid that a late tick skipped";
  EXPECT_EQ(events.at("i")[0]["name"], "2 points of the grid without a tick");
  double tick_end_us = 0.0, phase_end_us = 0.0;
  for (const json& slice : events.at("X")) {
    const double from_us = slice["ts"], to_us = from_us + slice["dur"].get<double>();
    const std::string name = slice["name"];
    if (name == "wake") continue;
    if (name.starts_with("tick ")) {
      EXPECT_GE(from_us, tick_end_us) << name;
      phase_end_us = from_us, tick_end_us = to_us;
    } else {
      EXPECT_NEAR(from_us, phase_end_us, 1e-6) << name;
      phase_end_us = to_us;
      EXPECT_LE(to_us, tick_end_us + 1e-6) << name;
    }
  }
}

TEST(TickTrace, NamesItsTracksAndReportsTheWakeUp) {
  const auto events = events_of(make_tick_trace({tick_at(7, 7'000'000)}, 1'000));
  std::vector<std::string> names;
  for (const json& name : events.at("M")) names.push_back(name["args"]["name"]);
  EXPECT_EQ(names, (std::vector<std::string>{"tact-jitter", "wake-up", "tact-loop"}));
  EXPECT_EQ(events.at("C")[0]["args"]["ns"], 5'000);
  for (const json& slice : events.at("X"))
    if (slice["name"] == "tick 7")
      EXPECT_NEAR(slice["ts"], 7'006.0, 1e-6)
          << "7 ms, woken 5 us late, on a clock that is 1 us ahead";
}

TEST(TickTrace, OfARealLoopHasItsTicks) {
  const auto scratch = std::move(*program::ScratchFolder::make("tact-trace-test"));
  const std::string out = scratch.file("run");
  const auto run =
      tests::run_program("tact-jitter", std::string(TACT_SOURCE_DIR) +
                                            "/model/scenes/liver.toml --duration 0.2 --out " + out);
  ASSERT_EQ(run.status, 0) << run.output;
  std::size_t ticks = 0;
  const auto text = model::io::read_file(out + "/ticks.trace.json");
  ASSERT_TRUE(text);
  const auto events = events_of(*text);
  for (const json& slice : events.at("X"))
    ticks += slice["name"].get<std::string>().starts_with("tick ") ? 1 : 0;
  EXPECT_GT(ticks, 100u);
  EXPECT_LE(ticks, 200u);
}

}  // namespace tact::tools::jitter::tick_trace_test
