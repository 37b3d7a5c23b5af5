// SPDX-License-Identifier: Apache-2.0
// The published cases of the disc stack, without the program around them.
#include "tests/tools/verify/verify_cases.h"
#include "tools/verify/report.h"

namespace tact::tools::verify::disc_test {

using nlohmann::json;

TEST(VerifyDisc, EveryPublishedCasePassesAndEveryFieldIsLookedAt) {
  tests::check_published_cases(disc_verifiers(), "001_disc_constants.json", 19);
  tests::check_published_cases(disc_verifiers(), "001_disc_stack.json", 66);
  tests::check_published_cases(disc_verifiers(), "001_disc_series.json", 200);
  tests::check_published_cases(disc_verifiers(), "001_disc_patent_printed.json", 1);
}

}  // namespace tact::tools::verify::disc_test
