// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hal/can/can_open.h"
#include "hal/can/can_settings.h"
#include "tests/support/forked.h"
#include "tests/support/message.h"

namespace tact::hal::can::can_lock_test {

using tests::Forked;
using tests::message_of;

/// Of an interface that every machine has, with nodes that no other run of these tests takes.
CanSettings drives(int first) {
  static const int mine = 10 * getpid();  // of the parent, in a child, too
  CanSettings settings;
  settings.interface = "lo";
  settings.node = {mine + first, mine + first + 1, mine + first + 2};
  return settings;
}

TEST(CanLock, ADriveOfAnotherProgramIsRefused) {
  const CanSettings theirs = drives(1);
  const Forked other([&] { lock_drives(theirs, false); });
  EXPECT_EQ(message_of(lock_drives(drives(4), false)), "") << "drives of their own";
  const std::string said = message_of(lock_drives(drives(3), false));
  EXPECT_NE(said.find("lo, node " + std::to_string(10 * getpid() + 3)), std::string::npos) << said;
  EXPECT_NE(said.find("process " + std::to_string(other.process())), std::string::npos) << said;
}

TEST(CanLock, OnlyOneGivesSyncOnABus) {
  const CanSettings theirs = drives(1);
  const Forked other([&] { lock_drives(theirs, true); });
  EXPECT_NE(message_of(lock_drives(drives(4), true)).find("the SYNC of lo"), std::string::npos);
  EXPECT_EQ(message_of(lock_drives(drives(4), false)), "");
}

TEST(CanLock, MissingInterfaceIsNotReportedByTheLock) {
  CanSettings settings = drives(1);
  settings.interface = "can-none";
  EXPECT_EQ(message_of(lock_drives(settings, true)), "");
}

}  // namespace tact::hal::can::can_lock_test
