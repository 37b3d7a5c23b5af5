// SPDX-License-Identifier: Apache-2.0
// can_bench.h - a delta on CAN with played drives, tick by tick, of any kind.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include "hal/can/can_bus.h"
#include "hal/can/can_delta.h"
#include "hal/can/can_settings.h"
#include "hal/device.h"
#include "model/device_settings.h"
#include "model/result.h"
#include "tests/support/example_delta.h"
#include "tests/support/no_alloc.h"

namespace tact::tests {

/// The example device with the arms on a jig, at a pose of the published vectors.
struct DeltaPoseCase {
  model::Vec3 position_D_m;
  hal::delta::Joints theta_rad{};
};
inline DeltaPoseCase published_pose(std::size_t index = 0) {
  std::ifstream file(std::string(TACT_SOURCE_DIR) + "/tests/data/vectors/kinematics_delta.json");
  const auto all = nlohmann::json::parse(file);
  const auto& one = all.at("devices").at("example_360x300").at("cases").at(index);
  const auto& p = one.at("p");
  DeltaPoseCase out{.position_D_m = {p.at(0), p.at(1), p.at(2)}};
  for (std::size_t i = 0; i < 3; ++i) out.theta_rad[i] = one.at("theta").at(i);
  return out;
}

inline model::DeviceSettings jig_settings(const DeltaPoseCase& pose) {
  model::DeviceSettings settings = example_delta();
  settings.of<hal::can::CanSettings>().homing = hal::can::Homing::kJig;
  settings.of<hal::can::CanSettings>().home_rad = pose.theta_rad;
  settings.of<hal::can::CanSettings>().direction = {1.0, -1.0, 1.0};
  return settings;
}

/// What the motors have to give for a force in W at that pose: hal's own statics, in one line each.
inline hal::delta::Joints expected_motor_Nm(const model::DeviceSettings& settings,
                                            const DeltaPoseCase& pose,
                                            const model::Vec3& force_W_N) {
  const hal::delta::DeltaKinematics delta(settings.of<hal::can::DeltaSettings>());
  const auto at = delta.pose(pose.position_D_m, pose.theta_rad);
  const model::Vec3 force_D{force_W_N.z, -force_W_N.y, force_W_N.x};  // W x is D z, W z is D x
  const auto push = hal::delta::joint_torques_Nm(at, force_D);
  const auto hold = hal::delta::gravity_torques_Nm(
      delta.geometry(), settings.of<hal::can::DeltaSettings>(), at, {-9.81, 0.0, 0.0});
  hal::delta::Joints out{};
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = settings.of<hal::can::CanSettings>().direction[i] * (push[i] + hold[i]) /
             settings.of<hal::can::DeltaSettings>().gear_ratio;
  return out;
}

/// One device, and drives that live a millisecond per tick. Drives: `millisecond`, `listen`, `bus`.
template <class Drives>
struct CanBench {
  using Bus = decltype(std::declval<Drives&>().bus.bus());
  using Start = model::Result<std::unique_ptr<hal::Device>> (*)(Bus, const model::DeviceSettings&,
                                                                double);

  explicit CanBench(const model::DeviceSettings& wanted) : settings(wanted) {}

  /// Empty, or the message why not.
  std::string open(Start start, double rate_Hz = 1000.0) {
    auto opened = start(drives.bus.bus(), settings, rate_Hz);
    if (!opened) return opened.error().message;
    device = std::move(*opened);
    drives.listen();
    return {};
  }

  /// The drives' millisecond, then one tick of the loop.
  model::Fault tick(const model::Vec3& force_N = {}) {
    drives.millisecond();
    return loop(force_N);
  }
  /// The loop's part alone.
  model::Fault loop(const model::Vec3& force_N = {}) {
    now_ns += 1'000'000;
    {
      const NoAlloc guard;
      const int calls = drives.bus.socket().calls;
      read_fault = device->read(sample, now_ns);
      device->permit(permitted);
      write_fault = device->write({.force_N = force_N, .torque_Nm = {}});
      system_calls = drives.bus.socket().calls - calls;
      allocations += guard.calls();
    }
    fresh_ticks += sample.fresh ? 1 : 0;
    drives.listen();
    return read_fault != model::Fault::kNone ? read_fault : write_fault;
  }
  /// Ticks until a force would pass, at a fresh sample; -1 if none would, or a fault comes first.
  int ticks_until_ready(int most = 1000) {
    for (int i = 1; i <= most; ++i) {
      if (tick() != model::Fault::kNone) return -1;
      if (sample.fresh && device->ready()) return i;
    }
    return -1;
  }
  /// Ticks until this fault; -1 if it does not come.
  int ticks_until(model::Fault fault, int most) {
    for (int i = 1; i <= most; ++i)
      if (tick() == fault) return i;
    return -1;
  }

  /// What the device has counted under this name; it fails the test when there is no such count.
  std::uint64_t count(std::string_view name) const {
    for (const hal::DeviceCount& one : device->counters())
      if (one.name == name) return one.count;
    ADD_FAILURE() << "no count " << name;
    return 0;
  }

  model::DeviceSettings settings;
  Drives drives;
  std::unique_ptr<hal::Device> device;
  hal::Sample sample;
  std::int64_t now_ns = 5'000'000'000;
  bool permitted = true;
  model::Fault read_fault = model::Fault::kNone, write_fault = model::Fault::kNone;
  int system_calls = 0;
  int fresh_ticks = 0;
  std::uint64_t allocations = 0;
};

}  // namespace tact::tests
