// SPDX-License-Identifier: Apache-2.0
// gated_run.h - a device at 1 kHz without a scene's loop, its force through the gate
// (firmware/gate/gate.h): at most 6 N, faded in, none outside the device's workspace, none above
// 0.3 m/s, none without fresh samples.
#pragma once

#include <cstdint>

#include "firmware/gate/gate.h"
#include "firmware/gate/limits_for.h"
#include "firmware/gate/workspace.h"
#include "firmware/loop/clock.h"
#include "firmware/loop/release_schedule.h"
#include "hal/device.h"
#include "model/fault.h"
#include "model/limits.h"

namespace tact::tools::calibrate {

inline constexpr std::int64_t kPeriod_ns = 1'000'000;

/// What a balanced weight needs: 0.5 kg by 2 mm are 10 mJ. The rest of energy_J is for the brake:
/// with 0.1 J the passivity stage allows 5.1 N. The device bounds the workspace.
inline constexpr model::Limits kLimits{.force_N = 6.0,
                                       .slew_N_per_s = 100.0,
                                       .ramp_s = 0.1,
                                       .workspace_radius_m = 1.0,
                                       .workspace_half_length_m = 1.0,
                                       .speed_mps = 0.3,
                                       .energy_J = 0.15,
                                       .continuous_force_N = 6.0,
                                       .power_W = 2.0};

/// Calls `tick(up_N)` once a period, after a sample was read, until it returns false. up_N is the
/// force that it wants, upwards; 0 is no force. The first fault of device or gate ends it, and so
/// does a force that is wanted outside the workspace: no weight can be balanced there. The last
/// write is zero.
template <typename Tick>
model::Fault run_gated(hal::Device& device, firmware::loop::Clock& clock, hal::Sample& sample,
                       Tick tick) {
  using model::Fault;
  const model::Limits limits = firmware::gate::limits_for(kLimits, device.info());
  firmware::gate::Gate gate(limits, 1e-9 * kPeriod_ns, 1.0);
  std::int64_t due_ns = clock.now_ns() + kPeriod_ns;
  std::int64_t skipped = 0;
  Fault fault = Fault::kNone;
  const auto note = [&fault](Fault next) {
    if (fault == Fault::kNone) fault = next;
  };
  for (bool more = true; more && fault == Fault::kNone;) {
    clock.sleep_until_ns(due_ns);
    sample.fresh = false;
    note(device.read(sample, clock.now_ns()));
    double up_N = 0.0;
    more = tick(up_N) && fault == Fault::kNone;
    const bool armed = more && up_N != 0.0;
    if (armed && !firmware::gate::is_inside(limits, sample.tool.position_m))
      note(Fault::kOutsideWorkspace);
    const firmware::gate::LimitedForce verdict =
        gate.limit({.wanted = {.force_N = {0.0, 0.0, up_N}, .torque_Nm = {}},
                    .tool = sample.tool,
                    .fresh = sample.fresh,
                    .armed = armed && fault == Fault::kNone,
                    .skipped_periods = static_cast<std::uint32_t>(skipped)});
    note(verdict.fault);
    note(device.write(verdict.wrench));
    due_ns += kPeriod_ns;  // a late tick skips whole periods, as in tactd
    skipped = firmware::loop::periods_missed(due_ns, clock.now_ns(), kPeriod_ns);
    due_ns += skipped * kPeriod_ns;
  }
  note(device.write({}));
  return fault;
}

}  // namespace tact::tools::calibrate
