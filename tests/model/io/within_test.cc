// SPDX-License-Identifier: Apache-2.0
#include "model/io/program/within.h"

#include <gtest/gtest.h>

namespace tact::model::io::within_test {

std::string refusal(const std::string& word) { return within(1e-3, 1e7)(std::string(word)); }

TEST(Within, TakesFiniteNumbersOfItsRange) {
  for (const char* word : {"1", "+1", "1e-3", "0.001", "1e7", "10000000", "2.5"})
    EXPECT_EQ(refusal(word), "") << word;
}

TEST(Within, NonFiniteOrMalformedNumberIsRefused) {
  for (const char* word :
       {"nan", "-nan", "NAN", "inf",  "-inf", "infinity", "1e400", "-1e400", "1e-400", "",
        " ",   "1s",   "1,5", "0x10", "1 2",  "++1",      "+-1",   "one",    "1e",     "."}) {
    const std::string said = refusal(word);
    EXPECT_NE(said.find("is no finite number in [0.001 - 10000000]"), std::string::npos)
        << word << ": " << said;
  }
}

TEST(Within, NumberOutsideTheRangeIsRefused) {
  for (const char* word : {"0", "-1", "9e-4", "10000001", "1e300", "-0"})
    EXPECT_NE(refusal(word).find("is not in ["), std::string::npos) << word;
}

TEST(Within, RangeIsShownInHelpAndEnforced) {
  for (const char* word : {"nan", "-1"}) {
    CLI::App app;
    double seconds = 0.0;
    app.add_option("--seconds", seconds, "")->check(within(1e-3, 1e7));
    EXPECT_NE(app.help().find("in [0.001 - 10000000]"), std::string::npos);
    EXPECT_THROW(app.parse(std::string("--seconds ") + word), CLI::ParseError);
  }
}

}  // namespace tact::model::io::within_test
