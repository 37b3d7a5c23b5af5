// SPDX-License-Identifier: Apache-2.0
// evidence.h - what makes a report one that can be filed: who, where, when, on which device, with
// which program, scene and limits.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/limits.h"
#include "model/result.h"

namespace tact::tools::limits {

/// What only a person knows.
struct Testers {
  std::string tester, place, number;  // of the report; an empty number is made
  std::vector<std::string> serials;   // of device, PC and other equipment
};

struct Evidence {
  Testers people;  // the number is never empty
  std::string host, began_utc, ended_utc;
  std::string program_sha256, tactd_sha256;  // of tact-limits itself; of the tactd beside it
  std::string tactd_path;                    // empty: there is none
  std::string scene_text, scene_sha256;
  std::vector<std::string> overrides;                       // --set
  std::string limits_text, limits_sha256, limits_checksum;  // in use
};

/// Letters, digits, space and -_./: as a report number is also the foot of each page.
std::optional<model::Error> check_number(const std::string& number);
/// Reads the scene and the programs. Taken before the plan is played, so that they are those that
/// were used. An error: one of them cannot be read.
model::Result<Evidence> collect_evidence(const std::string& scene_path,
                                         const std::vector<std::string>& overrides,
                                         const Testers& people);
/// When the plan was played: its limits, the time, and a number where none was given.
void close_evidence(Evidence& evidence, const model::Limits& in_use);

}  // namespace tact::tools::limits
