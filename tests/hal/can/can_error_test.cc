// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_error.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>

#include "hal/can/can_frame.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::can::can_error_test {

CanFrameBytes error_frame(std::uint32_t classes, std::uint8_t controller = 0) {
  CanFrameBytes bytes{};
  bytes[0] = static_cast<std::uint8_t>(classes);
  bytes[1] = static_cast<std::uint8_t>(classes >> 8);
  bytes[2] = static_cast<std::uint8_t>(classes >> 16);
  bytes[3] = 0x20;
  bytes[4] = 8;
  bytes[9] = controller;
  return bytes;
}
bool is_bus_gone(std::uint32_t classes, std::uint8_t controller = 0) {
  return decode_can_error(error_frame(classes, controller))->is_bus_gone();
}

TEST(CanError, OnlyBusOffRestartAndErrorPassiveMeanALostBus) {
  for (std::uint32_t classes = 1; classes <= 0x7FF; ++classes) {
    for (const unsigned state :
         {0x00u, 0x01u, 0x02u, 0x04u, 0x08u, 0x10u, 0x20u, 0x40u, 0x80u, 0x30u, 0x7Fu, 0x4Fu}) {
      const bool passive = (classes & 0x004) != 0 && (state & 0x30) != 0;
      EXPECT_EQ(is_bus_gone(classes, static_cast<std::uint8_t>(state)),
                (classes & 0x140) != 0 || passive)
          << classes << " " << state;
    }
  }
}

TEST(CanError, ControllerDataIsIgnoredUnlessItsErrorClassIsSet) {
  const auto quiet = decode_can_error(error_frame(0x002, 0x30));
  ASSERT_TRUE(quiet);
  EXPECT_EQ(quiet->controller, 0);
}

TEST(CanError, FramesOtherThanErrorsAreIgnored) {
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

TEST(CanError, EveryCauseHasItsOwnText) {
  const std::set<std::string> texts{CanError{.classes = 0x040}.text(),
                                    CanError{.classes = 0x100}.text(),
                                    CanError{.classes = 0x004, .controller = 0x10}.text(),
                                    CanError{.classes = 0x004, .controller = 0x20}.text()};
  EXPECT_EQ(texts.size(), 4u);
  EXPECT_EQ(CanError({.classes = 0x144, .controller = 0x30}).text(),
            std::string(CanError{.classes = 0x040}.text()))
      << "the worst one is said";
}

TEST(CanError, LeavesTheHeapAlone) {
  const CanFrameBytes bytes = error_frame(0x204, 0x30);
  const tests::NoAlloc guard;
  const auto error = decode_can_error(bytes);
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_TRUE(error);
}

}  // namespace tact::hal::can::can_error_test
