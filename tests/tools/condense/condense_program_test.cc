// SPDX-License-Identifier: Apache-2.0
// tact-lab condense as a person meets it: what it refuses before the work.
#include <gtest/gtest.h>

#include <string>

#include "tests/support/program.h"

namespace tact::tests::condense_program_test {

const std::string kLiver = TACT_SOURCE_DIR "/model/scenes/liver.toml";

void expect_refusal(const std::string& arguments, const std::string& message) {
  const Outcome outcome = run_program("tact-lab condense", arguments);
  EXPECT_EQ(outcome.status, 2) << outcome.output;
  EXPECT_EQ(outcome.output, "tact-lab condense: " + message + "\n");
}

TEST(CondenseProgram, RefusesLengthsThatAreNone) {
  for (const char* option : {"--mesh-size-m", "--patch-radius-m", "--ring-pitch-m"})
    for (const char* reported : {"-1 is not", "0 is not", "\"nan\" is no finite number",
                                 "\"inf\" is no finite number", "\"3mm\" is no finite number"}) {
      const std::string message = reported;
      std::string length = message.substr(0, message.find(' '));
      std::erase(length, '"');
      expect_refusal(
          kLiver + " --out x.map " + option + " " + length,
          std::string(option) + ": " + message + " in [1e-06 - 1]; see tact-lab condense --help");
    }
}

TEST(CondenseProgram, NamesTheKeysOfTheHeldBoxWhenItHoldsNothingOrEverything) {
  const auto held = [](const char* low, const char* high) {
    return kLiver + " --out x.map --set elastic.fixed_min_m=" + low +
           " --set elastic.fixed_max_m=" + high;
  };
  const std::string organ =
      "of the organ, which lies in [-0.05008, -0.07497, -0.03007] to [0.05009, 0.07499, 0.02999] "
      "there; make it hold a part (tact-mesh --align proposes one)";
  expect_refusal(
      held("[5,5,5]", "[6,6,6]"),
      "the held box, elastic.fixed_min_m = [5, 5, 5] to elastic.fixed_max_m = [6, 6, 6], "
      "holds no triangle " +
          organ);
  expect_refusal(held("[-1,-1,-1]", "[1,1,1]"),
                 "the held box, elastic.fixed_min_m = [-1, -1, -1] to elastic.fixed_max_m = [1, 1, "
                 "1], holds every triangle " +
                     organ);
}

TEST(CondenseProgram, TriesItsFileBeforeTheWork) {
  expect_refusal(
      kLiver + " --out /nowhere/liver.map",
      "/nowhere/liver.map: cannot be written: No such file or directory; check the folder, who may "
      "write there and the free space");
  expect_refusal(kLiver + " --out " + kLiver, kLiver +
                                                  ": would be overwritten, and is read; name "
                                                  "another");
}

}  // namespace tact::tests::condense_program_test
