// SPDX-License-Identifier: Apache-2.0
// cia402_bench.h - a delta with played CiA 402 drives, ready for force in one line.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "hal/cia402/cia402_delta.h"
#include "tests/hal/cia402/cia402_drives.h"
#include "tests/support/can_bench.h"

namespace tact::tests {

struct Cia402Bench : CanBench<PlayedCia402s> {
  Cia402Bench() : CanBench(jig_settings(published_pose())) {}
  std::string open() { return CanBench::open(&hal::cia402::start_cia402_delta); }
  void run() {
    ASSERT_EQ(open(), "");
    ASSERT_GT(ticks_until_ready(50), 0) << device->fault_detail();
    drives.forget();
  }
  double motor_Nm(std::size_t i) const {
    return 1e-6 * drives.axis[i].permille * drives.axis[i].rated;
  }
  bool says(const char* words) const {
    return device->fault_detail().find(words) != std::string::npos;
  }
  void expect_stopped() const {
    for (const auto& axis : drives.axis) {
      EXPECT_EQ(axis.permille, 0);
      EXPECT_EQ(axis.controlword, 0x02);
      EXPECT_NE(axis.status, 0x27);
    }
  }
  /// From now on: the same fault, no torque, no reset.
  void expect_latched(model::Fault fault) {
    drives.bus.socket().send_error = drives.bus.socket().receive_error = 0;
    for (auto& axis : drives.axis) {
      axis.status = 0x40;
      axis.nmt = hal::cia402::NmtState::kOperational;
      axis.says_heartbeat = axis.says_sample = true;
    }
    for (int i = 0; i < 200; ++i) {
      ASSERT_EQ(tick({0.0, 0.0, 5.0}), fault);
      ASSERT_EQ(read_fault, fault);
      ASSERT_EQ(write_fault, fault);
      ASSERT_FALSE(sample.fresh);
    }
    for (const auto& axis : drives.axis) {
      EXPECT_EQ(axis.permille, 0);
      EXPECT_NE(axis.status, 0x27);
      EXPECT_EQ(axis.fault_resets, 0);
    }
    EXPECT_EQ(allocations, 0u);
  }
};

}  // namespace tact::tests
