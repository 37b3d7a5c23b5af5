// SPDX-License-Identifier: Apache-2.0
// verify_cases.h - does a verifier pass every published case of its file, and does it look at every
// field? Each expected number, word and list element is spoiled in turn and must then fail.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "tools/verify/report.h"

namespace tact::tests {

/// A value that no tolerance takes for the right one.
inline nlohmann::json spoiled(const nlohmann::json& value) {
  if (value.is_boolean()) return !value.get<bool>();
  if (value.is_number()) return value.get<double>() * 1.001 + 1e-3;
  return "spoiled";
}

inline void check_published_cases(std::span<const tools::verify::Verifier> table,
                                  const std::string& name, int cases) {
  nlohmann::json file = nlohmann::json::parse(
      std::ifstream(std::string(TACT_SOURCE_DIR) + "/tests/data/vectors/" + name));
  const tools::verify::Verifier* verifier = nullptr;
  for (const tools::verify::Verifier& v : table)
    if (file.at("law") == v.law) verifier = &v;
  ASSERT_NE(verifier, nullptr) << name;

  tools::verify::Report report;
  verifier->verify(file, report);
  EXPECT_EQ(report.passed(), cases) << name;
  for (const tools::verify::Failure& f : report.failures())
    ADD_FAILURE() << name << ": " << f.id << " " << f.field << ": got " << f.got << ", want "
                  << f.want;

  const nlohmann::json all = file.at("cases");
  for (const nlohmann::json& one_case : all) {
    for (const auto& [field, value] : one_case.at("expect").items()) {
      nlohmann::json wrong = one_case;
      nlohmann::json& place = wrong["expect"][field];
      if (value.is_array())
        place.back() = spoiled(value.back());
      else
        place = spoiled(value);
      file["cases"] = nlohmann::json::array({wrong});
      tools::verify::Report spoiled_report;
      verifier->verify(file, spoiled_report);
      EXPECT_EQ(spoiled_report.failed(), 1) << name << ": " << one_case.at("id") << " " << field;
    }
  }
}

}  // namespace tact::tests
