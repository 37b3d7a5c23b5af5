// SPDX-License-Identifier: Apache-2.0
#include "tools/limits/report/hazard_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "model/io/json.h"
#include "model/io/program/installed.h"
#include "tools/limits/evidence/hazards.h"

namespace tact::tools::limits {
namespace {

using nlohmann::json;

/// What this run says of one of its own cases.
enum class Played : std::uint8_t { kNot, kPassed, kFailed };
const char* text_of(Played played) {
  constexpr const char* kWords[] = {"not played", "pass", "FAIL"};
  return kWords[static_cast<std::size_t>(played)];
}

Played played(const LimitsReport& report, const std::string& name) {
  const auto verdict = [](bool passed) { return passed ? Played::kPassed : Played::kFailed; };
  // The wall is no case of the plan's table.
  if (name == kWallName) return report.wall ? verdict(report.wall->passed()) : Played::kNot;
  for (const CaseResult& result : report.cases)
    if (name == result.verdict.subject.name) return verdict(result.verdict.passed());
  return Played::kNot;
}

/// Cases of this program that show the requirement, in the order of the table.
std::vector<std::string> own_cases(const Requirement& requirement) {
  std::vector<std::string> names;
  for (const HazardTest& test : requirement.tests)
    // The other tests ran elsewhere: this run says nothing about them.
    if (test.by == kOwnCommand) names.insert(names.end(), test.names.begin(), test.names.end());
  return names;
}

std::string acts_by(const Requirement& requirement) {
  std::string out = requirement.by;
  if (!requirement.stages.empty())
    out += fmt::format("; stage {}", fmt::join(requirement.stages, ", "));
  const char* before = requirement.faults.size() > 1 ? "; faults " : "; fault ";
  for (const int number : requirement.faults) {
    out += fmt::format("{}{} {}", before, number, model::describe(static_cast<Fault>(number)).name);
    before = ", ";
  }
  return out;
}

std::string ids_of(const std::vector<HazardTest>& tests) {
  std::vector<std::string> ids;
  for (const HazardTest& test : tests) ids.push_back(test.id);
  return fmt::format("{}", fmt::join(ids, ", "));
}

json requirement_data(const Requirement& requirement, const LimitsReport& report) {
  json here = json::array();
  for (const std::string& name : own_cases(requirement)) {
    const Played result = played(report, name);
    here.push_back({{"name", name},
                    {"words", text_of(result)},
                    {"style", result == Played::kPassed   ? "ok"
                              : result == Played::kFailed ? "bad"
                                                          : "quiet"}});
  }
  return {{"id", requirement.id},
          {"text", requirement.text},
          {"acts_by", acts_by(requirement)},
          {"tests", ids_of(requirement.tests)},
          {"here", here}};
}

json requirement_json(const Requirement& requirement, const LimitsReport& report) {
  json here = json::object(), tests = json::array();
  for (const std::string& name : own_cases(requirement)) here[name] = text_of(played(report, name));
  for (const HazardTest& test : requirement.tests) tests.push_back(test.id);
  return {{"id", requirement.id},         {"text", requirement.text},     {"by", requirement.by},
          {"stages", requirement.stages}, {"faults", requirement.faults}, {"tests", tests},
          {"in_this_run", here}};
}

json known_results() {
  const auto file = model::io::read_json(model::io::data_file("test_results.json"));
  return file && file->is_object() ? file->value("tests", json::object()) : json::object();
}

/// Of one test of the table: its own cases by this run, others by the file of results that lies
/// beside this program (tests/safety/results).
json test_json(const HazardTest& test, const LimitsReport& report, const json& known) {
  json out{{"result", "not known here"}, {"date", ""}, {"revision", ""}};
  if (test.by == kOwnCommand) {
    auto worst = Played::kPassed;
    for (const std::string& name : test.names)
      if (const Played one = played(report, name);
          one != Played::kPassed && worst != Played::kFailed)
        worst = one;
    out = {{"result", text_of(worst)},
           {"date", report.evidence.began_utc},
           {"revision", report.environment.git_revision}};
  } else if (known.contains(test.id)) {
    out.update(known[test.id]);
  }
  out.update({{"id", test.id}, {"by", test.by}, {"names", test.names}});
  return out;
}

/// The table, each requirement as `of` writes it.
json hazards_with(const LimitsReport& report, json (*of)(const Requirement&, const LimitsReport&)) {
  json out = json::array();
  for (const Hazard& hazard : hazard_table()) {
    json requirements = json::array();
    for (const Requirement& one : hazard.requirements) requirements.push_back(of(one, report));
    out.push_back({{"id", hazard.id},
                   {"hazard", hazard.hazard},
                   {"cause", hazard.cause},
                   {"remains", hazard.remains},
                   {"requirements", requirements}});
  }
  return out;
}

}  // namespace

json matrix_data(const LimitsReport& report) { return hazards_with(report, requirement_data); }

json tests_data(const LimitsReport& report) {
  json out = json::array();
  const json known = known_results();
  for (const HazardTest& test : hazard_tests()) {
    out.push_back(test_json(test, report, known));
    out.back()["names"] = fmt::format("{}", fmt::join(test.names, ", "));
    const json& result = out.back()["result"];
    out.back()["style"] = result == "pass" ? "ok" : result == "FAIL" ? "bad" : "part-text";
  }
  return out;
}

json hazards_json(const LimitsReport& report) {
  json tests = json::array();
  const json known = known_results();
  for (const HazardTest& test : hazard_tests()) tests.push_back(test_json(test, report, known));
  return {{"hazards", hazards_with(report, requirement_json)}, {"tests", tests}};
}

}  // namespace tact::tools::limits
