// SPDX-License-Identifier: Apache-2.0
// moteus_bench.h - a delta on the emulated moteus of the virtual bench, tick by tick.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "hal/moteus/moteus_delta.h"
#include "tests/hal/emulated/emulated_drives.h"
#include "tests/rig/emulators/moteus/moteus_drive.h"

namespace tact::tests {

struct EmulatedMoteus : EmulatedFdDrives {
  EmulatedMoteus() : EmulatedFdDrives(0x100) {}
};

struct MoteusBench : CanBench<EmulatedMoteus> {
  explicit MoteusBench(const rig::MoteusSettings& drive = {})
      : CanBench(jig_settings(published_pose())) {
    drives.install<rig::MoteusDrive>(drive);
    double turns = 0.37;
    for (auto& motor : drives.motor) motor.position_turns = turns += 1.0;  // wherever they began
  }
  std::string open() { return CanBench::open(&hal::moteus::start_moteus_delta); }
  /// Open and holding.
  void run() {
    ASSERT_EQ(open(), "");
    ASSERT_GT(ticks_until_ready(), 0) << device->fault_detail();
  }
  rig::MoteusDrive& axis(std::size_t i) const {
    return static_cast<rig::MoteusDrive&>(*drives.drive[i]);
  }
  bool says(const char* words) const {
    return device->fault_detail().find(words) != std::string::npos;
  }
  bool all_stopped() const {
    return axis(0).mode() == 0 && axis(1).mode() == 0 && axis(2).mode() == 0;
  }
  void expect_refused(const char* words) {
    const std::string message = open();
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_EQ(device, nullptr);
    EXPECT_EQ(drives.most_enabled, 0u) << "no power at opening";
  }
};

/// A drive that is not there.
struct DeadDrive final : rig::Drive {
  bool receive(const canfd_frame&, std::int64_t) override { return false; }
  void tick(std::int64_t) override {}
  void fail(std::int64_t) override {}
  bool warn(std::int64_t) override { return false; }
  bool is_enabled() const override { return false; }
  double torque_Nm() const override { return 0.0; }
  bool tripped() override { return false; }
};

}  // namespace tact::tests
