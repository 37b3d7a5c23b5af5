// SPDX-License-Identifier: Apache-2.0
#include "tools/limits/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "model/io/file_writer.h"
#include "model/io/json.h"
#include "tools/report/table.h"

namespace tact::tools::limits {
namespace {

namespace fs = std::filesystem;

/// Length of a vector, with the sign of its z, along which most cases act: what the curves show.
double along_z(const Vec3& v) { return v.z < 0.0 ? -norm(v) : norm(v); }

std::string word_of(std::string text) {  // a word of a table has no comma
  std::replace(text.begin(), text.end(), ',', ' ');
  return text;
}

report::Table trace_table(const CaseResult& result) {
  report::Table table(std::string("trace_") + result.verdict.subject.name);
  for (const TickRow& r : result.rows) {
    CaseVerdict stages;
    stages.acted = r.acted;
    table.add({{"t_s", r.t_s},
               {"commanded_N", along_z(r.commanded_N)},
               {"gated_N", along_z(r.gated_N)},
               {"written_N", along_z(r.written_N)},
               {"commanded_Nm", norm(r.commanded_Nm)},
               {"gated_Nm", norm(r.gated_Nm)},
               {"written_Nm", norm(r.written_Nm)},
               {"written_x_N", r.written_N.x},
               {"written_y_N", r.written_N.y},
               {"written_z_N", r.written_N.z},
               {"position_x_m", r.tool.position_m.x},
               {"position_y_m", r.tool.position_m.y},
               {"position_z_m", r.tool.position_m.z},
               {"speed_mps", norm(r.tool.velocity_mps)},
               {"power_W", model::given_power_W({r.written_N, r.written_Nm}, r.tool)},
               {"given_energy_J", r.given_energy_J},
               {"rms_N", r.rms_N},
               {"fresh", r.fresh},
               {"armed", r.armed},
               {"skipped_periods", r.skipped_periods},
               {"stages", word_of(stages.acted_text())},
               {"limit", static_cast<int>(r.limit)},
               {"fault", static_cast<int>(r.fault)}});
  }
  return table;
}

report::Table wall_table(const WallVerdict& wall) {
  report::Table table("wall");
  for (const WallPoint& p : wall.points)
    table.add({{"stiffness_N_per_m", p.stiffness_N_per_m},
               {"without_early_swing_m", p.without.early_swing_m},
               {"without_last_swing_m", p.without.last_swing_m},
               {"without_grows", p.without.grows},
               {"without_given_J", p.without.given_energy_J},
               {"with_early_swing_m", p.with.early_swing_m},
               {"with_last_swing_m", p.with.last_swing_m},
               {"with_grows", p.with.grows},
               {"with_given_J", p.with.given_energy_J},
               {"in_bounds", p.without.in_bounds && p.with.in_bounds}});
  return table;
}

}  // namespace

report::Row case_row(const CaseVerdict& v) {
  return {{"case", v.subject.name},
          {"passed", v.passed()},
          {"force_limit_N", v.limits.force_N},
          {"largest_commanded_N", v.worst.commanded_N},
          {"largest_written_N", v.worst.force_N},
          {"overshoot_N", v.overshoot_N},
          {"largest_torque_Nm", v.worst.torque_Nm},
          {"largest_step_N", v.worst.step_N},
          {"largest_step_Nm", v.worst.step_Nm},
          {"largest_power_W", v.worst.power_W},
          {"given_energy_J", v.worst.given_energy_J},
          {"largest_rms_N", v.worst.rms_N},
          {"largest_rms_Nm", v.worst.rms_Nm},
          // NaN: never, or not asked for.
          {"time_to_zero_s", v.worst.zero_s.value_or(std::nan(""))},
          {"allowed_zero_s", v.subject.expected.zero_within_s.value_or(std::nan(""))},
          {"stages", word_of(v.acted_text())},
          {"fault", static_cast<int>(v.fault)}};
}

bool LimitsReport::passed() const {
  // A run that played nothing has not passed.
  return !(cases.empty() && !wall) && (!wall || wall->passed()) &&
         std::all_of(cases.begin(), cases.end(),
                     [](const CaseResult& r) { return r.verdict.passed(); });
}

std::string LimitsReport::result_text() const {
  if (!passed()) return "FAIL";
  if (not_run.empty()) return "PASS";
  return fmt::format("PASS of {} of {} cases", played(), played() + not_run.size());
}

std::vector<std::pair<std::string, std::string>> LimitsReport::left_out_by_why() const {
  std::vector<std::pair<std::string, std::string>> groups;
  for (const LeftOut& out : not_run) {
    const auto same = std::find_if(groups.begin(), groups.end(),
                                   [&](const auto& g) { return g.first == out.why; });
    if (same == groups.end())
      groups.emplace_back(out.why, out.name);
    else
      same->second += ", " + out.name;
  }
  return groups;
}

std::string to_text(const LimitsReport& report) {
  std::string out;
  for (const CaseResult& result : report.cases) {
    const CaseVerdict& v = result.verdict;
    out += fmt::format("{:4}  {:16} {:7.3f} N of {:.3g}, overshoot {:g}, zero {}, {}\n",
                       v.passed() ? "ok" : "FAIL", v.subject.name, v.worst.force_N,
                       v.limits.force_N, v.overshoot_N,
                       v.worst.zero_s ? fmt::format("after {:.0f} ms", 1e3 * *v.worst.zero_s) : "-",
                       v.acted_text());
    for (const Check& c : v.checks)
      if (!c.holds) out += fmt::format("      FAIL: {}\n", c.message);
  }
  if (report.wall) {
    out += fmt::format("{:4}  {}\n", report.wall->passed() ? "ok" : "FAIL", kWallName);
    for (const Check& c : report.wall->checks)
      out += fmt::format("      {}{}\n", c.holds ? "" : "FAIL: ", c.message);
  }
  for (const auto& [why, names] : report.left_out_by_why())
    out += fmt::format("-     not tested, {}: {}\n", why, names);
  return out;
}

std::optional<model::Error> write_report(const LimitsReport& report, const std::string& directory) {
  const auto write = [&](const std::string& name, const std::string& content) {
    return model::io::write_file((fs::path(directory) / name).string(), content);
  };
  const auto write_table = [&](const report::Table& table) {
    return write(table.name() + ".csv", table.to_csv());
  };
  report::Table cases("cases");
  for (const CaseResult& result : report.cases) cases.add(case_row(result.verdict));
  if (!report.cases.empty())
    if (auto error = write_table(cases)) return error;
  // Every tick: the verdict can be checked without this program.
  for (const CaseResult& result : report.cases)
    if (auto error = write_table(trace_table(result))) return error;
  if (report.wall)
    if (auto error = write_table(wall_table(*report.wall))) return error;
  return write("limits.json", model::io::text_of(to_json(report), 2) + "\n");
}

}  // namespace tact::tools::limits
