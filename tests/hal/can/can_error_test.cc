// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_error.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <set>
#include <string>

#include "hal/can/can_frame.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::can::can_error_test {

CanFrameBytes error_frame(std::uint32_t classes, std::uint8_t controller = 0, std::uint8_t tx = 0,
                          std::uint8_t rx = 0) {
  CanFrameBytes bytes{};
  bytes[0] = static_cast<std::uint8_t>(classes);
  bytes[1] = static_cast<std::uint8_t>(classes >> 8);
  bytes[2] = static_cast<std::uint8_t>(classes >> 16);
  bytes[3] = 0x20;
  bytes[4] = 8;
  bytes[9] = controller;
  bytes[14] = tx;
  bytes[15] = rx;
  return bytes;
}
CanErrorAction action(std::uint32_t classes, std::uint8_t controller = 0) {
  return decode_can_error(error_frame(classes, controller))->action;
}

TEST(CanError, BusOffAndPassiveDisableTheDrivesWhateverElseIsSaid) {
  for (std::uint32_t also = 0; also <= 0x3FF; ++also) {
    EXPECT_EQ(action(also | 0x040), CanErrorAction::kDisableDrives);
    for (const std::uint8_t passive : std::array<std::uint8_t, 4>{0x10, 0x20, 0x30, 0x7F})
      EXPECT_EQ(action(also | 0x004, passive), CanErrorAction::kDisableDrives);
  }
}

TEST(CanError, EachClassHasItsAction) {
  EXPECT_EQ(action(0x001), CanErrorAction::kCount);
  EXPECT_EQ(action(0x002), CanErrorAction::kLog);
  EXPECT_EQ(action(0x008), CanErrorAction::kLog);
  EXPECT_EQ(action(0x010), CanErrorAction::kWarn);
  EXPECT_EQ(action(0x020), CanErrorAction::kCount);
  EXPECT_EQ(action(0x080), CanErrorAction::kLog);
  EXPECT_EQ(action(0x100), CanErrorAction::kLog);
  EXPECT_EQ(action(0x200), CanErrorAction::kLog);
  EXPECT_EQ(action(0x004, 0x04), CanErrorAction::kWarn);
  EXPECT_EQ(action(0x004, 0x08), CanErrorAction::kWarn);
  EXPECT_EQ(action(0x004, 0x40), CanErrorAction::kLog);
  EXPECT_EQ(action(0x024, 0x08), CanErrorAction::kWarn) << "the worst one counts";
}

TEST(CanError, ABitOfANewerKernelIsShownToSomebody) {
  EXPECT_EQ(action(0x400), CanErrorAction::kWarn);
  EXPECT_EQ(action(0x004, 0x80), CanErrorAction::kWarn);
}

TEST(CanError, DataOfAClassThatIsNotSetIsNotBelieved) {
  const auto quiet = decode_can_error(error_frame(0x002, 0x30, 200, 255));
  ASSERT_TRUE(quiet);
  EXPECT_EQ(quiet->controller, 0);
  EXPECT_FALSE(quiet->has_counters);
  EXPECT_EQ(quiet->tx_errors, 0);
  EXPECT_EQ(quiet->level(), CanErrorLevel::kActive);
  EXPECT_EQ(quiet->action, CanErrorAction::kLog);
}

TEST(CanError, TheWorseCounterGivesTheLevel) {
  const auto level = [](std::uint8_t tx, std::uint8_t rx) {
    return decode_can_error(error_frame(0x200, 0, tx, rx))->level();
  };
  EXPECT_EQ(level(95, 0), CanErrorLevel::kActive);
  EXPECT_EQ(level(0, 96), CanErrorLevel::kWarning);
  EXPECT_EQ(level(127, 3), CanErrorLevel::kWarning);
  EXPECT_EQ(level(3, 128), CanErrorLevel::kPassive);
  EXPECT_EQ(level(255, 255), CanErrorLevel::kPassive);
  EXPECT_EQ(can_error_level(255), CanErrorLevel::kPassive);
  EXPECT_EQ(can_error_level(256), CanErrorLevel::kBusOff);
}

TEST(CanError, WhatIsNoErrorFrameIsNotRead) {
  CanFrameBytes bytes = error_frame(0x040);
  ASSERT_TRUE(decode_can_error(bytes));
  EXPECT_FALSE(decode_can_error(std::span(bytes).first(15)));
  EXPECT_FALSE(decode_can_error({}));
  for (const std::uint8_t length : std::array<std::uint8_t, 4>{0, 7, 9, 255}) {
    bytes[4] = length;
    EXPECT_FALSE(decode_can_error(bytes)) << int{length};
  }
  bytes = error_frame(0x040);
  for (const std::uint8_t flags : std::array<std::uint8_t, 5>{0x00, 0x80, 0x40, 0xA0, 0x60}) {
    bytes[3] = flags;
    EXPECT_FALSE(decode_can_error(bytes)) << int{flags};
  }
  EXPECT_FALSE(decode_can_error(error_frame(0))) << "an error without a class says nothing";
}

TEST(CanError, EveryBitHasItsOwnWords) {
  const auto check = [](std::span<const CanErrorText> words, std::uint32_t all) {
    std::uint32_t bits = 0;
    std::set<std::string> names;
    for (const CanErrorText& one : words) {
      EXPECT_EQ(bits & one.bit, 0u) << one.name;
      bits |= one.bit;
      names.insert(one.name);
      EXPECT_GT(std::strlen(one.message), 20u) << one.name;
      EXPECT_EQ(one.message[std::strlen(one.message) - 1] == '.' ||
                    one.message[std::strlen(one.message) - 1] == '?',
                true)
          << one.message;
    }
    EXPECT_EQ(bits, all);
    EXPECT_EQ(names.size(), words.size());
  };
  check(can_error_class_texts(), 0x3FF);
  check(can_controller_texts(), 0x7F);
  for (const auto one : {CanErrorAction::kLog, CanErrorAction::kCount, CanErrorAction::kWarn,
                         CanErrorAction::kDisableDrives}) {
    EXPECT_NE(std::string(can_error_action_name(one)), "");
  }
}

TEST(CanError, LeavesTheHeapAlone) {
  const CanFrameBytes bytes = error_frame(0x204, 0x30, 200, 140);
  const tests::NoAlloc guard;
  const auto error = decode_can_error(bytes);
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_TRUE(error);
}

}  // namespace tact::hal::can::can_error_test
