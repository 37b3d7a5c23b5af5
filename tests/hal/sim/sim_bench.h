// SPDX-License-Identifier: Apache-2.0
// sim_bench.h - a simulated delta with a hand on it, ticked by a test.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>

#include "hal/sim/sim_delta.h"

namespace tact::tests {

using hal::Fault;
using hal::Sample;
using hal::Wrench;
using hal::sim::SimDelta;
using model::Vec3;

inline constexpr double kTick_s = 1e-3;
inline constexpr std::int64_t kTick_ns = 1'000'000;

inline hal::sim::SimDeviceSettings settings() {
  return {.counts_per_turn = 100'000.0,
          .sample_delay_s = 0.3e-3,
          .joint_friction_Nm = 0.01,
          .joint_damping_Nms_per_rad = 0.002,
          .observer_bandwidth_Hz = 40.0};
}
inline model::HandSettings hand_at(const Vec3& position_m, double stiffness_N_per_m) {
  model::HandSettings hand;
  hand.mass_kg = 0.2;
  hand.stiffness_N_per_m = stiffness_N_per_m;
  hand.damping_Ns_per_m = stiffness_N_per_m > 0.0 ? 12.0 : 0.0;
  hand.path = {{0.0, position_m, {}, 0.25}};
  return hand;
}
/// Reaches 0.07 m to the left and turns, in one second.
inline model::HandSettings moving_hand() {
  model::HandSettings hand = hand_at({}, 300.0);
  hand.path.push_back({1.0, {0.03, -0.07, 0.05}, {0.1, 0.2, -0.1}, 1.0});
  return hand;
}

struct Bench {
  explicit Bench(const hal::sim::SimDeviceSettings& device, const model::HandSettings& hand)
      : delta(device, hand) {}
  Sample tick(const Wrench& wrench = {}) {
    delta.between_ticks(kTick_s);
    now_ns += kTick_ns;
    Sample sample;
    EXPECT_EQ(delta.read(sample, now_ns), Fault::kNone);
    EXPECT_EQ(delta.write(wrench), Fault::kNone);
    return sample;
  }
  SimDelta delta;
  std::int64_t now_ns = 0;
};

}  // namespace tact::tests
