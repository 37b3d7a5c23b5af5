// SPDX-License-Identifier: Apache-2.0
// odrive_faults_bench.h - an ODrive delta that holds, and what must be true after a fault.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "hal/odrive/odrive_delta.h"
#include "tests/hal/odrive/odrive_drives.h"
#include "tests/support/can_bench.h"

namespace tact::tests {

struct OdriveFaultsBench : CanBench<PlayedOdrives> {
  explicit OdriveFaultsBench(bool v06 = true) : CanBench(jig_settings(published_pose())) {
    for (auto& axis : drives.axis) axis.v06 = v06;
  }
  void run() {
    ASSERT_EQ(open(&hal::odrive::start_odrive_delta), "");
    ASSERT_GT(ticks_until_ready(), 0) << device->fault_detail();
    drives.forget();
    tick({0.0, 0.0, 5.0});
  }
  bool says(const char* words) const {
    return device->fault_detail().find(words) != std::string::npos;
  }
  /// The fault stays, for all further behaviour of bus and drives; the hand has no force.
  void expect_latched(model::Fault fault) {
    for (auto& axis : drives.axis) axis.error = 0, axis.powered = axis.says_heartbeat = true;
    drives.bus.socket().send_error = drives.bus.socket().receive_error = 0;
    for (int i = 0; i < 400; ++i) {
      ASSERT_EQ(tick({0.0, 0.0, 5.0}), fault);
      ASSERT_EQ(read_fault, fault);
      ASSERT_EQ(write_fault, fault);
      ASSERT_FALSE(sample.fresh);
    }
    for (const auto& axis : drives.axis) EXPECT_EQ(axis.torque_Nm, 0.0f);
    EXPECT_EQ(allocations, 0u);
  }
  void expect_stopped() const {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(drives.axis[i].torque_Nm, 0.0f);
      EXPECT_EQ(drives.times(i, hal::odrive::OdriveCommand::kEstop), 1);
    }
  }
};

}  // namespace tact::tests
