// SPDX-License-Identifier: Apache-2.0
// emulated_drives.h - tact's back ends and the virtual bench's drives on one scripted bus.
//
// The emulators are written from the vendors' objects and share no header with hal/
// (tests/house/layering_test.py), so what both sides read alike is no accident of one reading. Time
// is made: each millisecond of the host is one of the drives.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>

#include "hal/shutdown_frames.h"
#include "tests/rig/emulators/can/can_bus.h"
#include "tests/rig/emulators/can/drive.h"
#include "tests/support/can_bench.h"
#include "tests/support/can_drives.h"

namespace tact::tests {

template <class Frame>
class BasicEmulatedDrives {
 public:
  explicit BasicEmulatedDrives(std::uint32_t node_step)
      : bus([this] { millisecond(); }),
        cable(plan_, node_step, !std::is_same_v<Frame, hal::can::CanFrame>) {
    cable.adopt(bus.give_drives_end());
  }

  /// `args` follow axis and node in the constructor of a drive.
  template <class Drive, class Settings>
  void install(const Settings& settings) {
    for (std::size_t i = 0; i < 3; ++i) install<Drive>(i, settings);
  }
  template <class Drive, class Settings>
  void install(std::size_t i, const Settings& settings) {
    const int axis = static_cast<int>(i);
    drive[i] = std::make_unique<Drive>(axis, axis + 1, settings, cable, motor[i], plan_);
  }
  /// Another host on the same drives, or another rate.
  void connect_again(const hal::can::CanRate& rate = {}) {
    close(cable.descriptor());
    bus.connect(rate);
    cable.adopt(bus.give_drives_end());
  }

  void listen() {
    while (const auto frame = cable.receive()) {
      for (const auto& one : drive) one->receive(*frame, now_ns);
      look();
    }
  }
  void millisecond() {
    listen();
    now_ns += 1'000'000;
    if (also) also();
    plan_.tick(now_ns);
    for (const auto& one : drive) one->tick(now_ns);
    look();
  }

  /// What the guardian says of a dead tactd: the first step takes the torque, the rest the power.
  void expect_freed_by(const hal::ShutdownFrames& frames) {
    ASSERT_EQ(send_step(frames, 0), 0);
    millisecond();
    for (const auto& one : drive) EXPECT_EQ(one->torque_Nm(), 0.0);
    ASSERT_EQ(send_all(frames), 0);
    millisecond();
    for (const auto& one : drive) EXPECT_FALSE(one->is_enabled());
  }

  std::int64_t now_ns = 1'000'000'000;
  std::array<rig::Motor, 3> motor{};
  std::array<std::unique_ptr<rig::Drive>, 3> drive{};
  std::size_t most_enabled = 0;    // at one time
  double largest_torque_Nm = 0.0;  // of any motor, at any time
  std::function<void()> also;      // in every millisecond
  BasicScriptedBus<Frame> bus;

 private:
  void look() {
    const auto enabled = std::count_if(drive.begin(), drive.end(),
                                       [](const auto& one) { return one->is_enabled(); });
    most_enabled = std::max(most_enabled, static_cast<std::size_t>(enabled));
    for (const auto& one : drive)
      largest_torque_Nm = std::max(largest_torque_Nm, std::abs(one->torque_Nm()));
  }

  rig::FaultPlan plan_;

 public:
  rig::CanBus cable;
};

struct EmulatedDrives : BasicEmulatedDrives<hal::can::CanFrame> {
  using BasicEmulatedDrives::BasicEmulatedDrives;
};
struct EmulatedFdDrives : BasicEmulatedDrives<hal::can::CanFdFrame> {
  using BasicEmulatedDrives::BasicEmulatedDrives;
};

}  // namespace tact::tests
