// The published cases of the disc stack, without the program around them.
#include "tools/verify_disc.cc"  // NOLINT(bugprone-suspicious-include)

#include "tests/verify_cases.h"
#include "tools/verify_report.cc"  // NOLINT(bugprone-suspicious-include)

namespace tact::tools {
namespace {

TEST(VerifyDisc, EveryPublishedCasePassesAndEveryFieldIsLookedAt) {
  tests::check_published_cases(disc_verifiers(), "001_disc_constants.json", 19);
  tests::check_published_cases(disc_verifiers(), "001_disc_stack.json", 66);
  tests::check_published_cases(disc_verifiers(), "001_disc_patent_printed.json", 1);
}

}  // namespace
}  // namespace tact::tools
