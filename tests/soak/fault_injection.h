// SPDX-License-Identifier: Apache-2.0
// fault_injection.h - what hands, devices, wires, clocks and operators do in a day, by chance with
// a seed.
#pragma once

#include <cstdint>

#include "firmware/loop/rt_loop.h"
#include "hal/sim/sim_delta.h"
#include "hal/sim/sim_lines.h"
#include "model/scene/scene.h"
#include "tools/stability/loop/random.h"

namespace tact::soak {

/// Steps once before each tick. Rates are per tick; the same seed does the same.
class FaultInjection {
 public:
  FaultInjection(std::uint64_t seed, const model::HandSettings& hand, std::int64_t period_ns)
      : chance_(seed), home_m_(hand.path.front().position_m), period_ns_(period_ns) {}

  void step(hal::sim::SimDelta& device, hal::sim::SimLines& lines,
            firmware::loop::SimulatedClock& clock, firmware::loop::Requests& requests,
            bool stopped);

 private:
  bool happens(double rate) { return chance_.uniform() < rate; }
  double between(double low, double high) { return low + (high - low) * chance_.uniform(); }
  int ticks_between(int low, int high) { return static_cast<int>(between(low, high)); }
  void move_hand(hal::sim::SimDelta& device);
  void spoil_device(hal::sim::SimDelta& device);
  void pull_wires(hal::sim::SimLines& lines);
  void operate(firmware::loop::Requests& requests, bool stopped);

  tools::stability::Random chance_;
  model::Vec3 home_m_;
  std::int64_t period_ns_;
  int hand_ticks_ = 0, spoilt_ticks_ = 0, wire_ticks_ = 0, operator_ticks_ = 0;
};

}  // namespace tact::soak
