// SPDX-License-Identifier: Apache-2.0
// Lost and late ticks: how much stiffness does a force that is held too long cost?
//
// lost: a tick brings no fresh sample with chance p and the force is held.
// late: a tick eats n more periods with chance p; the force is held through them.
// Theory: holds of n_i periods make K v^2 n_i^2 T^2 / 2 of energy each, damping takes b v^2 n_i T,
//
//     K < 2 b / T  E[n] / E[n^2]      lost: E[n]/E[n^2] = (1 - p) / (1 + p)
//                                     late: ((1-p) + p (1+n)) / ((1-p) + p (1+n)^2)
#include "model/law/haptic_limit.h"
#include "tools/stability/loop/gate_monitor.h"
#include "tools/stability/loop/haptic_loop.h"
#include "tools/stability/sweep/axes.h"
#include "tools/stability/sweep/map.h"

namespace tact::tools::stability {
namespace {

/// Additional periods that an event eats; 0: lost samples.
constexpr int kEaten[] = {0, 1, 3, 9};
std::vector<double> dampings_Ns_per_m(Extent extent) {
  if (extent == Extent::kQuick) return {2.0};
  return {0.5, 2.0};
}

std::vector<double> shares(Extent extent) {
  if (extent == Extent::kQuick) return {0.0, 0.1, 0.5};
  return {0.0, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
}

Axes<3> axes(Extent extent) {
  return {{std::size(kEaten), dampings_Ns_per_m(extent).size(), shares(extent).size()}};
}

double theory_N_per_m(const LoopCase& loop) {
  // HL-4: T becomes T (1 + p)/(1 - p) with a share p of ticks without a sample.
  if (loop.late_periods == 0)
    return model::law::haptic_limit(loop.device, loop.rate_Hz, 0.0, loop.lost_share).grow_N_per_m;
  const double p = loop.late_share, n = 1.0 + loop.late_periods;
  const double share = (1.0 - p + p * n) / (1.0 - p + p * n * n);
  return share * model::law::haptic_limit(loop.device, loop.rate_Hz).grow_N_per_m;
}

report::Row run(std::size_t job, Extent extent) {
  const auto [event, damping, share] = axes(extent).at(job);
  LoopCase loop;
  loop.device.damping_Ns_per_m = dampings_Ns_per_m(extent)[damping];
  loop.late_periods = kEaten[event];
  (loop.late_periods == 0 ? loop.lost_share : loop.late_share) = shares(extent)[share];
  // Rare events have to come: a share of 0.001 comes 30 times at 1 kHz.
  loop.duration_s = extent == Extent::kQuick ? 5.0 : 30.0;
  // One for all: neighbouring cells differ by their settings, not by their luck.
  loop.seed = 17;
  const double theory = theory_N_per_m(loop);
  const double measured = largest_wall_N_per_m(loop, Verdict::kGrow);
  GateMonitor gate(loop.rate_Hz);
  run_gated_wall(loop, 3.0 * measured, gate);
  return {{"event", loop.late_periods == 0 ? "lost" : "late"},
          {"periods_held", 1.0 + loop.late_periods},
          {"damping_Ns_per_m", loop.device.damping_Ns_per_m},
          {"share", shares(extent)[share]},
          {"theory_N_per_m", theory},
          {"largest_without_growth_N_per_m", measured},
          {"measured_over_theory", measured / theory},
          {"gate_max_force_N", gate.max_force_N()},
          {"gate_max_step_N", gate.max_step_N()},
          {"beyond_the_line", gate.beyond_the_line()}};
}

}  // namespace

Map tick_map() {
  return {.letter = 'd',
          .name = "ticks",
          .purpose = "largest stable wall over the share of lost and of late ticks",
          .jobs = [](Extent extent) { return axes(extent).jobs(); },
          .run = run};
}

}  // namespace tact::tools::stability
