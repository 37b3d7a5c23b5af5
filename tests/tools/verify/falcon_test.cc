// SPDX-License-Identifier: Apache-2.0
// The published bytes of the Falcon, without the program around them.
#include <gtest/gtest.h>

#include <fstream>

#include "hal/falcon/falcon_packets.h"
#include "tests/support/extent.h"
#include "tools/verify/report.h"

namespace tact::tools::verify::falcon_test {

using nlohmann::json;

json published() {
  return json::parse(std::ifstream(TACT_SOURCE_DIR "/tests/data/vectors/falcon_packets.json"));
}
Report report_on(const json& file) {
  Report report;
  falcon_verifiers()[0].verify(file, report);
  return report;
}

/// Another value of the same kind, one that counts: a motor word beyond the range is clamped.
json spoiled(const json& value) {
  if (value.is_boolean()) return !value.get<bool>();
  if (value.is_number_float()) return value.get<double>() * 1.001;
  if (value.is_number()) return value.get<int>() + (value.get<int>() > 0 ? -1 : 1);
  std::string hex = value;
  if (hex.empty()) return "00";
  hex.back() = hex.back() == '0' ? '1' : '0';
  return hex;
}

TEST(VerifyFalcon, EveryPublishedCasePasses) {
  const Report report = report_on(published());
  EXPECT_EQ(report.passed(), 95);
  for (const Failure& f : report.failures())
    ADD_FAILURE() << f.id << " " << f.field << ": got " << f.got << ", want " << f.want;
}

TEST(VerifyFalcon, EveryValueIsLookedAt) {
  const json file = published();
  int looked_at = 0;
  const json flat = file.flatten();
  for (const auto& [where, value] : flat.items()) {
    const auto names = [&](const char* word) { return where.find(word) != std::string::npos; };
    // prose; and a stream's chunks, of which much is damage that may as well be another
    if (names("/schema") || names("/rules") || names("/note") || names("/chunks")) continue;
    if (names("/motors_requested") && std::abs(value.get<int>()) > hal::falcon::kFalconMotorMax)
      continue;
    if (looked_at++ % (10 / static_cast<int>(tests::share_of(10, 10))) != 0) continue;
    json wrong = file;
    wrong[json::json_pointer(where)] = spoiled(value);
    const Report report = report_on(wrong);
    EXPECT_TRUE(report.failed() > 0 || !report.damage().empty()) << where << " " << value;
  }
  EXPECT_GT(looked_at, 600);
}

}  // namespace tact::tools::verify::falcon_test
