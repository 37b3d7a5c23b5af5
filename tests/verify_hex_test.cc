// The published cases of the hexagonal surface, without the program around them.
#include "tools/verify_hex.cc"  // NOLINT(bugprone-suspicious-include)

#include "tests/verify_cases.h"
#include "tools/verify_report.cc"  // NOLINT(bugprone-suspicious-include)

namespace tact::tools {
namespace {

TEST(VerifyHex, EveryPublishedCasePassesAndEveryFieldIsLookedAt) {
  tests::check_published_cases(hex_verifiers(), "002_hex_energy.json", 30);
  tests::check_published_cases(hex_verifiers(), "002_hex_paper.json", 52);
}

}  // namespace
}  // namespace tact::tools
