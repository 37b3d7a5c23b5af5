// SPDX-License-Identifier: Apache-2.0
// The matrix hazard, requirement, stage and fault, test of a report, for limits.json.
#include <nlohmann/json.hpp>
#include <string_view>

#include "model/io/json.h"
#include "model/io/program/installed.h"
#include "tools/limits/evidence/hazards.h"
#include "tools/limits/report/report.h"

namespace tact::tools::limits {
namespace {

using nlohmann::json;

constexpr std::string_view kPassed = "pass", kFailed = "FAIL";

/// What this run says of one of its own cases.
std::string_view played(const LimitsReport& report, const std::string& name) {
  constexpr std::string_view kNot = "not played";
  const auto verdict = [](bool passed) { return passed ? kPassed : kFailed; };
  // The wall is no case of the plan's table.
  if (name == kWallName) return report.wall ? verdict(report.wall->passed()) : kNot;
  for (const CaseResult& result : report.cases)
    if (name == result.verdict.subject.name) return verdict(result.verdict.passed());
  return kNot;
}

json requirement_json(const Requirement& requirement, const LimitsReport& report) {
  json here = json::object(), tests = json::array(), faults = json::array();
  for (const int number : requirement.faults)
    faults.push_back(model::describe(static_cast<Fault>(number)).name);
  for (const HazardTest& test : requirement.tests) {
    tests.push_back(test.id);
    // The other tests ran elsewhere: this run says nothing about them.
    if (test.by == kOwnCommand)
      for (const std::string& name : test.names) here[name] = played(report, name);
  }
  return {{"id", requirement.id},         {"text", requirement.text},     {"by", requirement.by},
          {"stages", requirement.stages}, {"faults", requirement.faults}, {"tests", tests},
          {"fault_names", faults},        {"in_this_run", here}};
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
    std::string_view worst = kPassed;
    for (const std::string& name : test.names)
      if (const auto one = played(report, name); one != kPassed && worst != kFailed) worst = one;
    out = {{"result", worst},
           {"date", report.evidence.began_utc},
           {"revision", report.environment.git_revision}};
  } else if (known.contains(test.id)) {
    out.update(known[test.id]);
  }
  out.update({{"id", test.id}, {"by", test.by}, {"names", test.names}});
  return out;
}

}  // namespace

json hazards_json(const LimitsReport& report) {
  json hazards = json::array(), tests = json::array();
  const json known = known_results();
  for (const HazardTest& test : hazard_tests()) tests.push_back(test_json(test, report, known));
  for (const Hazard& hazard : hazard_table()) {
    json requirements = json::array();
    for (const Requirement& one : hazard.requirements)
      requirements.push_back(requirement_json(one, report));
    hazards.push_back({{"id", hazard.id},
                       {"hazard", hazard.hazard},
                       {"cause", hazard.cause},
                       {"remains", hazard.remains},
                       {"requirements", requirements}});
  }
  return {{"hazards", hazards}, {"tests", tests}};
}

}  // namespace tact::tools::limits
