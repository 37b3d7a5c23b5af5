// SPDX-License-Identifier: Apache-2.0
// cia402_emulated_bench.h - a delta on three emulated CiA 402 drives with habits of a vendor.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "hal/cia402/cia402_delta.h"
#include "tests/hal/emulated/emulated_drives.h"
#include "tests/rig/emulators/cia402/cia402_drive.h"

namespace tact::hal::emulated {

using rig::ObjectHabits;
using tests::published_pose;

inline constexpr double kRated_Nm = 0.32;

struct Cia402Drives : tests::EmulatedDrives {
  Cia402Drives() : EmulatedDrives(1) {}
  rig::Cia402Drive& at(std::size_t i) { return dynamic_cast<rig::Cia402Drive&>(*drive[i]); }
  bool any_noted() {
    return !at(0).noted().empty() || !at(1).noted().empty() || !at(2).noted().empty();
  }
};

struct Cia402Bench : tests::CanBench<Cia402Drives> {
  explicit Cia402Bench(const ObjectHabits& habits = {})
      : CanBench(tests::jig_settings(published_pose())) {
    drives.install<rig::Cia402Drive>(
        rig::Cia402Settings{.rated_torque_Nm = kRated_Nm, .habits = habits});
    for (int i = 0; i < 50; ++i) drives.millisecond();  // they boot
  }
  /// What a host that guards the drives says once.
  void guard() {
    for (std::uint32_t i = 0; i < 3; ++i) {
      canfd_frame request{};
      request.can_id = CAN_RTR_FLAG | (0x701 + i);
      drives.drive[i]->receive(request, drives.now_ns);
    }
  }
  std::string open() { return CanBench::open(&cia402::start_cia402_delta); }
  /// Open and ready for a force.
  testing::AssertionResult run() {
    const std::string message = open();
    if (!message.empty()) return testing::AssertionFailure() << message;
    if (ticks_until_ready() < 0) return testing::AssertionFailure() << device->fault_detail();
    return testing::AssertionSuccess();
  }
  void expect_no_fault_for(int ticks) {
    for (int i = 0; i < ticks; ++i) ASSERT_EQ(tick(), Fault::kNone) << device->fault_detail();
  }
  void expect_torques_of(const Vec3& force_N) {
    for (int i = 0; i < 3; ++i) ASSERT_EQ(tick(force_N), Fault::kNone) << device->fault_detail();
    const auto wanted = tests::expected_motor_Nm(settings, published_pose(), force_N);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(drives.drive[i]->torque_Nm(), wanted[i], 0.5e-3 * kRated_Nm);
  }
};

}  // namespace tact::hal::emulated
