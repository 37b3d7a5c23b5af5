// SPDX-License-Identifier: Apache-2.0
// A burst of lost samples: what each policy does to the hand.
//
// The tool is 2 N deep in a wall of 1 kN/m when the samples stop, and the hand withdraws with
// 0.1 m/s. Per length of the burst: the force at its end, and the energy that the hand got beyond
// what the wall itself would have given back, if the controller
//
//     holds   the last force for ever
//     gate    holds one tick, ramps down to zero within 10 ms, latches at 20 (firmware/gate/gate.h)
#include <algorithm>

#include "tools/stability/loop/gate_monitor.h"
#include "tools/stability/sweep/axes.h"
#include "tools/stability/sweep/map.h"

namespace tact::tools::stability {
namespace {

constexpr double kRates_Hz[] = {1000.0, 4000.0};
// Chosen: out of the wall in 20 ms, so the fade ends while the hand is still inside.
constexpr double kSpeed_mps = 0.1;
constexpr double kWall_N_per_m = 1000.0;
constexpr double kPush_N = 2.0;
constexpr std::size_t kLongest = 41;  // 0 .. 40 ticks

Axes<2> axes(Extent extent) {
  return {{extent == Extent::kQuick ? 1 : std::size(kRates_Hz), kLongest}};
}

report::Row run(std::size_t job, Extent extent) {
  const auto [rate, lost] = axes(extent).at(job);
  const double period_s = 1.0 / kRates_Hz[rate];
  GateMonitor gate(kRates_Hz[rate]);
  // Armed and at the wall's force before the burst begins.
  gate.open(kPush_N);
  double depth_m = kPush_N / kWall_N_per_m, hold_J = 0.0, gate_J = 0.0;
  for (std::size_t i = 0; i < lost; ++i) {
    gate.step(kPush_N, false);
    // the hand withdraws: a force pushes it on its way; the wall's own share is not a gift
    const double way_m = std::min(kSpeed_mps * period_s, depth_m);
    const double wall_J = kWall_N_per_m * (depth_m - 0.5 * way_m) * way_m;
    // The hand goes on beyond the surface, and so does a held force.
    hold_J += kPush_N * kSpeed_mps * period_s - wall_J;
    gate_J += gate.written_N() * kSpeed_mps * period_s - wall_J;
    depth_m -= way_m;
  }
  const char* state = lost == 0                ? "fresh"
                      : lost == 1              ? "held"
                      : gate.is_latched()      ? "latched"
                      : gate.written_N() > 0.0 ? "fading"
                                               : "zero";
  return {{"rate_Hz", kRates_Hz[rate]},
          {"lost_in_a_row", lost},
          {"hold_force_N", kPush_N},
          {"gate_force_N", gate.written_N()},
          {"hold_gift_J", hold_J},
          {"gate_gift_J", gate_J},
          {"gate_max_step_N", gate.max_step_N()},
          {"gate_max_force_N", gate.max_force_N()},
          {"state", state}};
}

}  // namespace

Map loss_map() {
  return {.letter = 'd',
          .name = "loss",
          .purpose = "a burst of lost samples: hold, fade, latch, and what the hand gets",
          .jobs = [](Extent extent) { return axes(extent).jobs(); },
          .run = run,
          .facts = [] { return nlohmann::json{{"slew_N_per_s", kSceneLimits.slew_N_per_s}}; }};
}

}  // namespace tact::tools::stability
