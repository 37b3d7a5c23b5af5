// SPDX-License-Identifier: Apache-2.0
#include "model/fault.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace tact::model::fault_test {

TEST(Fault, EveryEntryHasNameCauseAndRemedy) {
  for (const FaultEntry& entry : fault_table()) {
    EXPECT_GT(std::strlen(entry.name), 0u);
    EXPECT_GT(std::strlen(entry.cause), 0u);
    EXPECT_GT(std::strlen(entry.remedy), 0u);
  }
}

// One fault serves classic CAN and CAN FD; the message beside it knows which, and where.
TEST(Fault, NoRemedyNamesOneInterfaceOrOneKindOfBus) {
  for (const FaultEntry& entry : fault_table()) {
    EXPECT_EQ(std::string(entry.remedy).find("can0"), std::string::npos) << entry.name;
    EXPECT_EQ(std::string(entry.remedy).find("bitrate"), std::string::npos) << entry.name;
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
  EXPECT_FALSE(latches(Fault::kToolInside));
  EXPECT_FALSE(latches(Fault::kContactLost));
  EXPECT_FALSE(latches(Fault::kClutchPressed));
  EXPECT_TRUE(latches(Fault::kUnknown));
  EXPECT_TRUE(latches(Fault::kDeviceLost));
}

TEST(Fault, ToolInsideContactLostAndClutchKeepNumbersAndNames) {
  EXPECT_EQ(static_cast<int>(Fault::kToolInside), 14);
  EXPECT_STREQ(describe(Fault::kToolInside).name, "inside the organ");
  EXPECT_EQ(static_cast<int>(Fault::kContactLost), 15);
  EXPECT_STREQ(describe(Fault::kContactLost).name, "contact lost");
  EXPECT_EQ(static_cast<int>(Fault::kClutchPressed), 16);
  EXPECT_STREQ(describe(Fault::kClutchPressed).name, "clutch pressed");
}

TEST(Fault, ANumberThatTheTableDoesNotHaveIsReportedAsUnknown) {
  EXPECT_EQ(describe(static_cast<Fault>(9999)).fault, Fault::kUnknown);
  EXPECT_EQ(describe(Fault::kForceLimited).fault, Fault::kForceLimited);
}

}  // namespace tact::model::fault_test
