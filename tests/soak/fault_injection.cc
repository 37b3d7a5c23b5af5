// SPDX-License-Identifier: Apache-2.0
#include "tests/soak/fault_injection.h"

#include "tests/support/pass_time.h"

namespace tact::soak {

void FaultInjection::step(hal::sim::SimDelta& device, hal::sim::SimLines& lines,
                          firmware::loop::SimulatedClock& clock, firmware::loop::Requests& requests,
                          bool stopped) {
  move_hand(device);
  spoil_device(device);
  pull_wires(lines);
  operate(requests, stopped);
  if (happens(1e-4)) tests::pass_ns(clock, ticks_between(1, 30) * period_ns_ + period_ns_ / 3);
}

// Mostly into the tissue and along it, sometimes to where the device itself gives way.
void FaultInjection::move_hand(hal::sim::SimDelta& device) {
  if (--hand_ticks_ > 0) return;
  hand_ticks_ = ticks_between(20, 1500);
  const double reach_m = happens(0.05) ? 0.20 : 0.03;
  hal::sim::HandTarget target;
  target.position_m[0] = home_m_.x + between(-reach_m, reach_m);
  target.position_m[1] = home_m_.y + between(-reach_m, reach_m);
  target.position_m[2] = between(-0.03, 0.02);
  target.grip_ratio = between(0.0, 1.0);
  device.hand_targets().write(target);
}

void FaultInjection::spoil_device(hal::sim::SimDelta& device) {
  hal::sim::SimFaults& faults = device.faults();
  if (spoilt_ticks_ > 0 && --spoilt_ticks_ == 0) {
    faults.nan_sample.store(false);
    faults.device.store(model::Fault::kNone);
  }
  if (happens(3e-4)) faults.drop_samples.store(ticks_between(1, 30));
  if (spoilt_ticks_ > 0 || !happens(1e-4)) return;
  spoilt_ticks_ = ticks_between(1, 40);
  if (happens(0.5))
    faults.nan_sample.store(true);
  else
    faults.device.store(model::Fault::kDeviceFailed);
}

void FaultInjection::pull_wires(hal::sim::SimLines& lines) {
  hal::sim::SimLines::Inputs& inputs = lines.inputs();
  if (wire_ticks_ > 0 && --wire_ticks_ == 0) {
    inputs.estop_a.store(true);
    inputs.estop_b.store(true);
    inputs.dead_man.store(true);
  }
  if (wire_ticks_ > 0 || !happens(1e-4)) return;
  wire_ticks_ = ticks_between(1, 300);
  if (happens(0.3)) {
    inputs.dead_man.store(false);
    return;
  }
  inputs.estop_a.store(false);
  inputs.estop_b.store(happens(0.002));  // one channel alone: stays a fault until the next morning
}

// Resets and arms when it has stopped, and sometimes presses what it should not.
void FaultInjection::operate(firmware::loop::Requests& requests, bool stopped) {
  using firmware::loop::Request;
  if (happens(1e-4)) requests.ask(happens(0.5) ? Request::kArm : Request::kReset);
  if (happens(1e-5)) requests.ask(Request::kDisarm);
  if (--operator_ticks_ > 0) return;
  operator_ticks_ = ticks_between(5, 200);
  requests.ask(stopped ? Request::kReset : Request::kArm);
}

}  // namespace tact::soak
