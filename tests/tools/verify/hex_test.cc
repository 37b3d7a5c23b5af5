// SPDX-License-Identifier: Apache-2.0
// The published cases of the hexagonal surface, without the program around them.
#include "tests/tools/verify/verify_cases.h"
#include "tools/verify/report.h"

namespace tact::tools::verify::hex_test {

using nlohmann::json;

TEST(VerifyHex, EveryPublishedCasePassesAndEveryFieldIsLookedAt) {
  tests::check_published_cases(hex_verifiers(), "002_hex_energy.json", 30);
  tests::check_published_cases(hex_verifiers(), "002_hex_paper.json", 52);
  tests::check_published_cases(hex_verifiers(), "002_membrane.json", 16);
}

}  // namespace tact::tools::verify::hex_test
