#include "model/fault.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

namespace tact::model {
namespace {

TEST(Fault, EveryEntryHasNameCauseAndCure) {
  for (const FaultEntry& entry : fault_table()) {
    EXPECT_GT(std::strlen(entry.name), 0u);
    EXPECT_GT(std::strlen(entry.cause), 0u);
    EXPECT_GT(std::strlen(entry.cure), 0u);
  }
}

TEST(Fault, NumbersAscendAndAreNeverShared) {
  int before = -1;
  for (const FaultEntry& entry : fault_table()) {
    EXPECT_GT(static_cast<int>(entry.fault), before);
    before = static_cast<int>(entry.fault);
  }
}

TEST(Fault, LatchesFromOneHundred) {
  EXPECT_FALSE(latches(Fault::kNone));
  EXPECT_FALSE(latches(Fault::kLawSaturated));
  EXPECT_TRUE(latches(Fault::kInternal));
  EXPECT_TRUE(latches(Fault::kDeviceLost));
}

TEST(Fault, UnknownNumbersAreDescribedAsInternal) {
  EXPECT_EQ(describe(static_cast<Fault>(9999)).fault, Fault::kInternal);
  EXPECT_EQ(describe(Fault::kForceLimited).fault, Fault::kForceLimited);
}

// The page shows the same words (host/web/src/faults.ts); it cannot include ours.
TEST(Fault, ThePageSaysTheSameWordsUnderTheSameNumbers) {
  std::ifstream file(TACT_SOURCE_DIR "/host/web/src/faults.ts");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::regex entry(
      R"re((\d+): \{\s*name: "([^"]*)",\s*cause:\s*"([^"]*)",\s*cure:\s*"([^"]*)",?\s*\})re");
  std::size_t found = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), entry), end; it != end; ++it, ++found) {
    const FaultEntry& ours = describe(static_cast<Fault>(std::stoi((*it)[1])));
    EXPECT_EQ(static_cast<int>(ours.fault), std::stoi((*it)[1]));
    EXPECT_EQ((*it)[2], ours.name);
    EXPECT_EQ((*it)[3], ours.cause);
    EXPECT_EQ((*it)[4], ours.cure);
  }
  EXPECT_EQ(found, fault_table().size());
}

}  // namespace
}  // namespace tact::model
