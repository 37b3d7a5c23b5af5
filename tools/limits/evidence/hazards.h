// SPDX-License-Identifier: Apache-2.0
// hazards.h - the table of hazards that is built in (tests/safety/hazards.toml), and what this run
// adds to it: from a hazard to the requirements that meet it, and to what shows each of them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tact::tools::limits {

struct HazardTest {
  std::string id, by;              // TEST-nn; the command that runs it
  std::vector<std::string> names;  // tests, properties or cases
};

struct Requirement {
  std::string id, text, by;  // REQ-nn; `by`: the part of tact that meets it
  std::vector<std::string> stages;
  std::vector<int> faults;
  std::vector<HazardTest> tests;
};

struct Hazard {
  std::string id, hazard, cause, remains;
  std::vector<Requirement> requirements;
};

/// In the order of the table. A requirement of two hazards is below both.
std::vector<Hazard> hazard_table();
/// Every test of the table once, in its order.
std::vector<HazardTest> hazard_tests();
/// The command of a HazardTest whose names are cases of this program.
inline constexpr std::string_view kOwnCommand = "tact-limits";

}  // namespace tact::tools::limits
