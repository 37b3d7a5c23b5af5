// SPDX-License-Identifier: Apache-2.0
#include "hal/odrive/odrive_errors.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <set>
#include <string>

namespace tact::hal::odrive::odrive_errors_test {

TEST(OdriveErrors, EveryBitOfTheVendorHasItsOwnMessage) {
  const auto check = [](std::span<const OdriveErrorText> table, std::uint32_t all) {
    std::uint32_t bits = 0;
    std::set<std::string> names, messages;
    for (const OdriveErrorText& one : table) {
      EXPECT_TRUE(std::has_single_bit(one.bit)) << one.name;
      EXPECT_EQ(bits & one.bit, 0u) << one.name;
      bits |= one.bit;
      names.insert(one.name);
      messages.insert(one.message);
      const std::string message = one.message;
      EXPECT_GT(message.size(), 30u) << one.name;
      EXPECT_TRUE(message.back() == '.' || message.back() == '?') << message;
    }
    EXPECT_EQ(bits, all);
    EXPECT_EQ(names.size(), table.size());
    EXPECT_EQ(messages.size(), table.size());
  };
  check(odrive_error_texts(), 0x5F01FF7F);
  check(odrive_error_texts_05(), 0x000E7FFF);
}

TEST(OdriveErrors, TheSameBitMeansAnotherThingInTheOtherGeneration) {
  EXPECT_STREQ(first_odrive_error(0x200)->name, "DC_BUS_UNDER_VOLTAGE");
  EXPECT_STREQ(first_odrive_error_05(0x200)->name, "CONTROLLER_FAILED");
  EXPECT_STREQ(first_odrive_error(0x1000000)->name, "WATCHDOG_TIMER_EXPIRED");
  EXPECT_STREQ(first_odrive_error_05(0x800)->name, "WATCHDOG_TIMER_EXPIRED");
}

TEST(OdriveErrors, EveryErrorBitHasAMessageAndZeroHasNone) {
  EXPECT_EQ(first_odrive_error(0), nullptr);
  EXPECT_EQ(first_odrive_error_05(0), nullptr);
  for (int bit = 0; bit < 32; ++bit) {
    for (const OdriveErrorText* words :
         {first_odrive_error(1u << bit), first_odrive_error_05(1u << bit)}) {
      ASSERT_NE(words, nullptr) << bit;
      EXPECT_GT(std::strlen(words->message), 30u) << bit;
      EXPECT_TRUE(words->bit == 1u << bit || std::string(words->name) == "UNKNOWN") << bit;
    }
  }
  EXPECT_STREQ(first_odrive_error(0x80)->name, "UNKNOWN");
  EXPECT_STREQ(first_odrive_error(0x300)->name, "DC_BUS_OVER_VOLTAGE");
}

}  // namespace tact::hal::odrive::odrive_errors_test
