// SPDX-License-Identifier: Apache-2.0
// What limits.html shows: first the verdict and the limits that were tested, then a row for each
// case, then the curves.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "model/io/limits_checksum.h"
#include "tools/limits/report/hazard_page.h"
#include "tools/limits/report/limit_rows.h"
#include "tools/limits/report/limits.html.h"
#include "tools/report/page.h"

namespace tact::tools::limits {
namespace {

using nlohmann::json;

json facts(const LimitsReport& report) {
  const firmware::pc::Environment& e = report.environment;
  json out = json::array();
  const auto add = [&](const char* name, const std::string& value) {
    out.push_back({{"name", name}, {"value", value}});
  };
  const Evidence& evidence = report.evidence;
  add("Report number", evidence.people.number);
  add("Tested by", evidence.people.tester);
  add("Place", evidence.people.place);
  add("Serial numbers", fmt::format("{}", fmt::join(evidence.people.serials, "; ")));
  add("Begun, ended", evidence.began_utc.empty()
                          ? report.started
                          : fmt::format("{}, {}", evidence.began_utc, evidence.ended_utc));
  add("Host", fmt::format("{}: {}, Linux {}", evidence.host, e.cpu, e.kernel_release));
  add("Device", report.device_name + (report.simulated ? " (SIMULATED, on simulated time)" : ""));
  add("Scene", fmt::format("{} ({}), hash {}", report.scene_name, report.scene_path, e.scene_hash));
  add("Rate", fmt::format("{:g} Hz: times are whole ticks of {:g} ms, their resolution",
                          1.0 / report.period_s, 1e3 * report.period_s));
  // Simulated time needs no real time: the line would frighten for nothing.
  if (!report.simulated && !report.hard_real_time)
    add("Real time", fmt::format("this PC gives no hard real time; force capped to {:g} %",
                                 100.0 * report.force_share));
  if (!report.simulated)
    add("Guards", fmt::format("the watch above the loop, the runaway guard{}",
                              report.call_filter ? ", the filter on the loop's system calls"
                                                 : "; no filter on the loop's system calls"));
  add("Limits checksum",
      fmt::format("{} (SHA-256 {})", evidence.limits_checksum, evidence.limits_sha256));
  add("Limits checksum that tactd shows on this PC", model::io::limits_checksum(report.pc_limits));
  add("SHA-256 of the scene", evidence.scene_sha256);
  add("SHA-256 of tact-limits", evidence.program_sha256);
  add("SHA-256 of tactd", evidence.tactd_path.empty()
                              ? "none lies beside tact-limits"
                              : fmt::format("{} ({})", evidence.tactd_sha256, evidence.tactd_path));
  add("Software", fmt::format("tact {}, {}", e.git_revision, e.compiler));
  add("Command", report.command);
  return out;
}

json limit_data(const LimitRow& row, std::size_t number) {
  const auto with_unit = [&](double v) { return fmt::format("{:.4g} {}", v, row.unit); };
  const bool is_seen = row.largest > 0.0 || row.kept != Kept::kNotReached;
  json tighter = json::array();
  for (const TighterLimit& t : row.tighter)
    tighter.push_back({{"case", t.case_name},
                       {"limit", with_unit(t.limit)},
                       {"largest", with_unit(t.largest)},
                       {"holds", t.holds}});
  return {{"name", row.name},
          {"key", row.key},
          {"limit", with_unit(row.limit)},
          {"scene", with_unit(row.scene.limit)},
          {"pc", with_unit(row.pc.limit)},
          {fmt::format("is_{}", number), true},
          {"largest", is_seen ? with_unit(row.largest) : "-"},
          {"reached_by",
           row.reached_by.empty() ? "-" : fmt::format("{}", fmt::join(row.reached_by, ", "))},
          {"style", row.kept == Kept::kFail         ? "bad"
                    : row.kept == Kept::kNotReached ? "part-text"
                                                    : "ok"},
          {"kept", kept_text(row.kept)},
          {"tighter", tighter}};
}

bool is_reported(const LimitsReport& report, const CaseVerdict& v) {
  return !report.simulated && opens_line(v.subject);
}

std::string tightened(const model::Limits& here, const model::Limits& all) {
  std::string out;
  if (here.power_W < all.power_W) out += fmt::format(" Here at most {:.3g} W.", here.power_W);
  if (here.energy_J < all.energy_J) out += fmt::format(" Here at most {:.3g} J.", here.energy_J);
  if (here.continuous_force_N < all.continuous_force_N)
    out += fmt::format(" Here at most {:.3g} N RMS over {:g} s.", here.continuous_force_N,
                       here.thermal_time_s);
  return out;
}

/// Four digits, and none of them an exponent.
std::string plain(double value) {
  // An impulse of 10^6 N for a reader who knows no exponents.
  return value < 1e4 ? fmt::format("{:.4g}", value) : fmt::format("{:.0f}", value);
}

json case_data(const CaseVerdict& v, const LimitsReport& report) {
  json broken = json::array();
  std::string criteria;
  for (const Check& c : v.checks) {
    if (!c.holds) broken.push_back(c.message);
    // What the case asks besides the limits, which are the same for all: from its stage on.
    if (!criteria.empty() || c.message.starts_with("the stage "))
      criteria += (criteria.empty() ? "" : "; ") + c.message;
  }
  const auto& allowed = v.subject.expected.zero_within_s;
  return {{"name", v.subject.name},
          {"what", v.subject.what},
          {"tightened", tightened(v.limits, report.limits)},
          {"injected", is_reported(report, v) ? kReportedInSoftware : ""},
          {"has_broken", !broken.empty()},
          {"criteria", criteria},
          {"broken", broken},
          {"commanded", plain(v.worst.commanded_N) + " N"},
          {"written", fmt::format("{:.4g} N", v.worst.force_N)},
          {"overshoot", fmt::format("{:.3g} N", v.overshoot_N)},
          {"zero", v.worst.zero_s ? fmt::format("{:.4g} ms", 1e3 * *v.worst.zero_s) : "-"},
          {"allowed", allowed ? fmt::format("{:.4g} ms", 1e3 * *allowed) : "-"},
          {"stages", v.acted_text()},
          {"fault", v.fault == Fault::kNone ? "" : model::describe(v.fault).name},
          {"holds", v.passed()}};
}

json wall_data(const WallVerdict& wall, const std::string& plot) {
  json checks = json::array();
  for (const Check& c : wall.checks)
    checks.push_back({{"holds", c.holds}, {"sentence", c.message}});
  return {{"checks", checks},
          {"theory", fmt::format("{:.4g}", wall.theory_N_per_m)},
          {"picture", plot}};
}

/// What the page fills in as it is: words, numbers, and flags.
json text_data(const LimitsReport& report) {
  const auto failed = static_cast<std::size_t>(std::ranges::count_if(
                          report.cases, [](const auto& r) { return !r.verdict.passed(); })) +
                      (report.wall && !report.wall->passed() ? 1 : 0);
  const bool kept = report.played() > 0 && failed == 0;
  const model::Limits &l = report.limits, &s = report.scene_limits;
  return {{"result", report.result_text()},
          {"played", std::to_string(report.played())},
          {"not_played", std::to_string(report.not_run.size())},
          {"none_played", report.played() == 0},
          {"failed", failed > 0 ? std::to_string(failed) : ""},
          {"all_kept", kept && report.not_run.empty()},
          {"part_kept", kept && !report.not_run.empty()},
          {"has_left_out", !report.not_run.empty()},
          {"facts", facts(report)},
          {"number", report.evidence.people.number},
          {"tester", report.evidence.people.tester},
          {"hazards", matrix_data(report)},
          {"tests", tests_data(report)},
          {"limits_text", report.evidence.limits_text},
          {"limits_sha256", report.evidence.limits_sha256},
          {"scene_path", report.scene_path},
          {"scene_sha256", report.evidence.scene_sha256},
          {"scene_text", report.evidence.scene_text},
          {"has_overrides", !report.evidence.overrides.empty()},
          {"overrides", report.evidence.overrides},
          {"speed_mps", fmt::format("{:g}", l.speed_mps)},
          {"workspace_radius_m", fmt::format("{:g}", l.workspace_radius_m)},
          {"workspace_half_length_m", fmt::format("{:g}", l.workspace_half_length_m)},
          {"recovery_W", fmt::format("{:g}", l.recovery_W)},
          {"force_N", fmt::format("{:g}", report.scene_limits.force_N)},
          {"full_W", fmt::format("{:.3g}", s.force_N * s.speed_mps + s.torque_Nm * s.turn_radps)},
          {"brake_J",
           fmt::format("{:.3g}", model::brake_energy_J(
                                     s.speed_mps + s.torque_Nm / s.force_N * s.turn_radps,
                                     s.force_N, slew_beside_ramp_N_per_s(s), report.period_s))},
          {"has_cases", !report.cases.empty()},
          {"simulated", report.simulated},
          {"any_injected", std::ranges::any_of(report.cases, [&](const auto& r) {
             return is_reported(report, r.verdict);
           })}};
}

}  // namespace

std::string page_html(const LimitsReport& report, const std::vector<std::string>& svg) {
  json data = text_data(report);
  for (const auto& [why, names] : report.left_out_by_why())
    data["left_out"].push_back({{"why", why}, {"names", names}});
  for (const LimitRow& row : limit_rows(report))
    data["limits"].push_back(limit_data(row, data["limits"].size()));
  for (const CaseResult& r : report.cases) data["cases"].push_back(case_data(r.verdict, report));
  const std::size_t curves = svg.size() - (report.wall && !svg.empty() ? 1 : 0);  // the wall last
  for (std::size_t i = 0; i < curves; ++i) data["curves"].push_back(report::inline_svg(svg[i], i));
  data["has_curves"] = curves > 0;
  if (report.wall)
    data["wall"] =
        wall_data(*report.wall, svg.size() > curves ? report::inline_svg(svg.back(), curves) : "");
  return report::render_page(kText, data);
}

}  // namespace tact::tools::limits
