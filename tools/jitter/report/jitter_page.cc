// SPDX-License-Identifier: Apache-2.0
// A measurement as one HTML file.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/jitter/report/jitter.html.h"
#include "tools/jitter/report/jitter_report.h"
#include "tools/report/page.h"

namespace tact::tools::jitter {
namespace {

using nlohmann::json;

constexpr std::size_t kListed = 20;  // late ticks

json column_names() {
  json out{"samples"};
  for (const Share& share : kShares) out.push_back(share.name);
  out.insert(out.end(), {"largest", "at, s", "tick"});
  return out;
}

json series_rows(const JitterResult& result) {
  json rows = json::array();
  for (const NamedSeries& named : series_of(result)) {
    const auto& h = named.series->histogram;
    json cells{std::to_string(h.count())};
    for (const Share& share : kShares) cells.push_back(in_us(percentile_ns(h, share.value)));
    cells.push_back(in_us(h.max_ns()));
    // cyclictest reports buckets: no tick and no time.
    const bool of_peer = named.key == "peer_wake";
    cells.push_back(of_peer ? ""
                            : fmt::format("{:.3f}", seconds_into(result, named.series->max_at_ns)));
    cells.push_back(of_peer ? "" : std::to_string(h.max_tick()));
    rows.push_back({{"title", named.title}, {"cells", cells}});
  }
  return rows;
}

json late_rows(const JitterResult& result) {
  json rows = json::array();
  const auto late = result.sink->late_ticks();
  for (std::size_t i = 0; i < std::min(late.size(), kListed); ++i) {
    const TickTimes& t = late[i].times;
    rows.push_back(
        {{"why", late[i].attribution},
         {"at_s", fmt::format("{:.3f}", seconds_into(result, t.due_ns))},
         {"tick", std::to_string(t.tick)},
         {"worst_us", in_us(static_cast<std::uint64_t>(late[i].worst_ns))},
         {"wake_us", in_us(static_cast<std::uint64_t>(t.phase(firmware::loop::Phase::kWake)))},
         {"skipped", std::to_string(t.skipped_before)}});
  }
  return rows;
}

std::string count(const std::optional<std::uint64_t>& value) {
  return value ? std::to_string(*value) : "not readable here";
}

json cost_rows(const JitterResult& result) {
  const Costs& c = result.costs;
  const firmware::run::ThreadCosts& t = result.thread;
  json rows = json::array();
  const auto add = [&](const std::string& name, const std::string& value) {
    rows.push_back({{"name", name}, {"value", value}});
  };
  add("heap calls of the loop", t.heap_calls_known ? std::to_string(t.heap_calls) : "not counted");
  add("page faults, minor and major", fmt::format("{} and {}", t.minor_faults, t.major_faults));
  add("switches, its own and forced",
      fmt::format("{} and {}", t.voluntary_switches, t.involuntary_switches));
  add("migrations to another core", count(c.migrations));
  add("us ready while another ran",
      c.waited_ns ? in_us(*c.waited_ns) : std::string("not readable here"));
  add("ms taken by a hypervisor, whole core", count(c.steal_ms));
  add("system management interrupts", count(c.smi));
  std::vector<std::pair<std::uint64_t, std::string>> sources;
  for (const auto& [source, n] : c.interrupts) sources.emplace_back(n, source);
  // The most frequent first.
  std::sort(sources.rbegin(), sources.rend());
  for (const auto& [n, source] : sources)
    add("interrupts of its core: " + source, std::to_string(n));
  return rows;
}

json pc_rows(const std::vector<firmware::pc::PcRow>& pc) {
  json rows = json::array();
  for (const firmware::pc::PcRow& r : pc)
    rows.push_back({{"name", r.name},
                    {"verdict", name_of(r.verdict)},
                    {"found", r.found},
                    {"why", r.why},
                    {"remedy", r.remedy}});
  return rows;
}

json facts(const JitterResult& result) {
  const firmware::pc::Environment& e = result.environment;
  json rows = json::array();
  const auto add = [&](const char* name, const std::string& value) {
    rows.push_back({{"name", name}, {"value", value}});
  };
  add("kernel", e.kernel_release + " " + e.kernel_version);
  add("booted with", e.boot_parameters);
  add("CPU", fmt::format("{}, microcode {}, {} online", e.cpu, e.microcode, e.cores));
  add("clock", e.clock_source);
  add("tact", e.git_revision);
  add("compiler", e.compiler);
  add("scene", e.scene_hash.empty() ? "none" : e.scene_hash);
  return rows;
}

json peer_data(const JitterResult& result) {
  if (!result.peer) return nullptr;
  json out{{"compared", compare_with_peer(result)}};
  if (const auto verdict = check_peer(result))
    // Too few turns are neither green nor red.
    out["gate"] = {{"color", !verdict->turns     ? "unknown"
                             : verdict->passed() ? "green"
                                                 : "red"},
                   {"sentence", verdict->message()}};
  return out;
}

}  // namespace

std::string make_page(const JitterResult& result, const std::string& command,
                      const std::string& histogram_svg) {
  const json late = late_rows(result);
  return report::render_page(
      kText, {{"subject", result.subject},
              {"headline", make_headline(result)},
              {"non_rt", result.non_rt},
              {"outcome", outcome_of(result).message},
              {"outcome_style", outcome_of(result).style},
              {"began", result.began_utc},
              {"host", result.host},
              {"cpu", result.environment.cpu},
              {"histogram", report::inline_svg(histogram_svg, 0)},
              {"columns", column_names()},
              {"series", series_rows(result)},
              {"ticks", std::to_string(result.sink->ticks())},
              {"peer", peer_data(result)},
              {"late_ticks", std::to_string(result.sink->over_threshold())},
              {"threshold_us", in_us(static_cast<std::uint64_t>(result.sink->threshold_ns()))},
              {"late_listed", std::to_string(late.size())},
              {"has_marker", result.has_marker},
              {"has_late", !late.empty()},
              {"late", late},
              {"costs", cost_rows(result)},
              {"pc", pc_rows(result.pc)},
              {"facts", facts(result)},
              {"command", command}});
}

}  // namespace tact::tools::jitter
