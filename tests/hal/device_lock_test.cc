// SPDX-License-Identifier: Apache-2.0
#include "hal/device_lock.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/forked.h"
#include "tests/support/message.h"

namespace tact::hal::device_lock_test {

using tests::Forked;
using tests::message_of;

/// Neither another test nor another run of this one has a device of this name.
std::string device_of_mine() {
  return testing::UnitTest::GetInstance()->current_test_info()->name() + std::to_string(getpid());
}

TEST(DeviceLock, ASecondProgramIsRefusedByThePidOfTheFirst) {
  const std::string name = device_of_mine();
  const Forked other([&] { lock_device(name); });
  const std::string said = message_of(lock_device(name));
  EXPECT_TRUE(
      said.starts_with(name + " is driven by process " + std::to_string(other.process()) + " ("))
      << said;
}

TEST(DeviceLock, GoesWithTheProcessHoweverItEnds) {
  const std::string name = device_of_mine();
  Forked other([&] { lock_device(name); });
  ASSERT_TRUE(lock_device(name));
  other.kill_now();
  EXPECT_EQ(message_of(lock_device(name)), "");
}

TEST(DeviceLock, IsOfOneDeviceAndOneProgramMayTakeItAgain) {
  const std::string name = device_of_mine();
  const Forked other([&] { lock_device(name); });
  EXPECT_EQ(message_of(lock_device(name + "b")), "");
  EXPECT_EQ(message_of(lock_device(name + "b")), "");
}

TEST(DeviceLock, NamesThePidHoweverManyHaveAsked) {
  const std::string name = device_of_mine();
  const Forked other([&] { lock_device(name); });
  for (int i = 0; i < 1000; ++i)
    ASSERT_NE(message_of(lock_device(name)).find(std::to_string(other.process())),
              std::string::npos)
        << i;
}

TEST(DeviceLock, ANameThatFitsNowhereIsRefused) {
  EXPECT_NE(message_of(lock_device(std::string(200, 'x'))).find("too long"), std::string::npos);
}

}  // namespace tact::hal::device_lock_test
