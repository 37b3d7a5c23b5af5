// SPDX-License-Identifier: Apache-2.0
// The report for machines: limits.json.
#include <nlohmann/json.hpp>

#include "model/io/limits_checksum.h"
#include "tools/limits/report/limit_rows.h"

namespace tact::tools::limits {
namespace {

using nlohmann::json;

json checks_json(const std::vector<Check>& checks) {
  json out = json::array();
  for (const Check& c : checks) out.push_back({{"holds", c.holds}, {"sentence", c.message}});
  return out;
}

/// The limits that the case made tighter.
json tightened_json(const model::Limits& here, const model::Limits& all) {
  json out = json::object();
  if (here.power_W < all.power_W) out["power_W"] = here.power_W;
  if (here.energy_J < all.energy_J) out["energy_J"] = here.energy_J;
  if (here.continuous_force_N < all.continuous_force_N)
    out.update(
        {{"continuous_force_N", here.continuous_force_N}, {"thermal_time_s", here.thermal_time_s}});
  return out;
}

/// Has it a moment to mark?
bool has_cause(const Case& c) {
  return c.injected != InjectedFault::kNone || c.shape == Shape::kNan ||
         c.shape == Shape::kInfinity;
}

json case_json(const CaseVerdict& v, const LimitsReport& report) {
  json out;
  const bool drives_torque =
      v.subject.grip == Grip::kLever && v.subject.reaches && v.limits.torque_Nm > 0.0;
  for (const auto& [column, cell] : case_row(v))
    std::visit([&out, column](const auto& value) { out[column] = value; }, cell);
  // A NaN of the table is null here: a number would be a claim.
  out.update(
      {{"what", v.subject.what},
       // On a real device no program opens a line: this was no test of the wire.
       {"cause", report.simulated || !opens_line(v.subject) ? "played" : kReportedInSoftware},
       {"passed", v.passed()},
       {"stages", v.acted_text()},
       {"fault", static_cast<int>(v.fault)},
       {"fault_name", v.fault == Fault::kNone ? "" : model::describe(v.fault).name},
       {"duration_s", v.subject.duration_s},
       {"cause_s", has_cause(v.subject) ? json(kCause_s) : json()},
       {"drives", drives_torque ? "torque" : "force"},
       {"torque_limit_Nm", v.limits.torque_Nm},
       {"tightened", tightened_json(v.limits, report.limits)},
       {"checks", checks_json(v.checks)}});
  return out;
}

json limit_json(const LimitRow& row) {
  json tighter = json::array();
  for (const TighterLimit& t : row.tighter)
    tighter.push_back(
        {{"case", t.case_name}, {"value", t.limit}, {"largest", t.largest}, {"holds", t.holds}});
  return {{"limit", row.name},
          {"key", row.key},
          {"unit", row.unit},
          {"value", row.limit},
          {"scene_value", row.scene.limit},
          {"on_this_pc", row.pc.limit},
          {"largest", row.largest},
          {"kept", kept_text(row.kept)},
          {"reached_by", row.reached_by},
          {"tighter", tighter}};
}

json report_json(const LimitsReport& report) {
  const Evidence& e = report.evidence;
  return {{"number", e.people.number},
          {"tester", e.people.tester},
          {"place", e.people.place},
          {"serial_numbers", e.people.serials},
          {"host", e.host},
          {"began", e.began_utc},
          {"ended", e.ended_utc}};
}

json digests_json(const Evidence& e) {
  return {
      {"tact_limits", e.program_sha256},
      // tact-limits evaluates the parts that it has in common with tactd, so both files are named.
      {"tactd", e.tactd_path.empty() ? json() : json(e.tactd_sha256)},
      {"scene", e.scene_sha256},
      {"limits", e.limits_sha256}};
}

/// What the rows of limits leave out, and what the scene's own limits come to.
json other_limits_json(const LimitsReport& report) {
  const model::Limits &l = report.limits, &s = report.scene_limits;
  return {{"speed_mps", l.speed_mps},
          {"workspace_radius_m", l.workspace_radius_m},
          {"workspace_half_length_m", l.workspace_half_length_m},
          {"recovery_W", l.recovery_W},
          {"full_power_W", s.force_N * s.speed_mps + s.torque_Nm * s.turn_radps},
          {"least_energy_J",
           model::brake_energy_J(s.speed_mps + s.torque_Nm / s.force_N * s.turn_radps, s.force_N,
                                 slew_beside_ramp_N_per_s(s), report.period_s)}};
}

json wall_json(const WallVerdict& wall) {
  return {{"passed", wall.passed()},
          {"theory_N_per_m", wall.theory_N_per_m},
          {"bounded_without_N_per_m", wall.bounded_without_N_per_m},
          {"bounded_with_N_per_m", wall.bounded_with_N_per_m},
          {"bounded_with_is_a_least_value", wall.with_is_least},
          {"bounded_ratio", wall.bounded_ratio()},
          {"rest_without_N_per_m", wall.rest_without_N_per_m},
          {"rest_with_N_per_m", wall.rest_with_N_per_m},
          {"rest_ratio", wall.rest_ratio()},
          {"largest_swing_without_m", wall.swing_without_m},
          {"largest_swing_with_m", wall.swing_with_m},
          {"checks", checks_json(wall.checks)}};
}

}  // namespace

json to_json(const LimitsReport& report) {
  json limits = json::array(), cases = json::array(), not_run = json::array();
  for (const LimitRow& row : limit_rows(report)) limits.push_back(limit_json(row));
  for (const LeftOut& out : report.not_run)
    not_run.push_back({{"case", out.name}, {"why", out.why}});
  for (const CaseResult& result : report.cases) cases.push_back(case_json(result.verdict, report));
  const firmware::pc::Environment& e = report.environment;
  const Evidence& evidence = report.evidence;
  json out{{"format", "tact-limits"},
           {"version", 1},
           {"report", report_json(report)},
           {"limits_checksum", evidence.limits_checksum},
           {"limits_checksum_on_this_pc", model::io::limits_checksum(report.pc_limits)},
           {"limits_text", evidence.limits_text},
           {"other_limits", other_limits_json(report)},
           {"tactd_path", evidence.tactd_path},
           {"sha256", digests_json(evidence)},
           {"scene_text", evidence.scene_text},
           {"overrides", evidence.overrides},
           {"hazard_table", hazards_json(report)},
           {"passed", report.passed()},
           {"result", report.result_text()},
           {"cases_played", report.played()},
           // So that "2 passed" cannot be read as all.
           {"cases_of_plan", report.played() + report.not_run.size()},
           {"command", report.command},
           {"started", report.started},
           {"scene", report.scene_name},
           {"scene_path", report.scene_path},
           {"scene_hash", e.scene_hash},
           {"device", report.device_name},
           {"simulated", report.simulated},
           {"force_share", report.force_share},
           {"hard_real_time", report.hard_real_time},
           {"call_filter", report.call_filter},
           {"rate_Hz", 1.0 / report.period_s},
           {"limits", limits},
           {"cases", cases},
           {"not_run", not_run},
           {"environment",
            {{"kernel", e.kernel_release},
             {"cpu", e.cpu},
             {"revision", e.git_revision},
             {"compiler", e.compiler}}}};
  if (report.wall) out["wall"] = wall_json(*report.wall);
  return out;
}

}  // namespace tact::tools::limits
