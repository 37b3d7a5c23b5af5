// SPDX-License-Identifier: Apache-2.0
// The closed haptic loop on a wall F = K x: how stiff may it be?
//
// Per cell: the largest K without growth and the largest K that comes to rest, beside K_grow and
// K_safe of model/law/haptic_limit.h; then the same loop at three times the measured limit, through
// the gate. "bare" is the hand that gives no help: it pushes with a constant force.
#include <algorithm>

#include "model/law/haptic_limit.h"
#include "tools/stability/loop/gate_monitor.h"
#include "tools/stability/loop/haptic_loop.h"
#include "tools/stability/sweep/axes.h"
#include "tools/stability/sweep/map.h"

namespace tact::tools::stability {
namespace {

struct Hand {
  const char* name;
  HandAtTool at_tool;
};
// Chosen: a hand that gives no help, a light grip and a firm one.
constexpr Hand kHands[] = {
    {"bare", {}},
    {"light", {.mass_kg = 0.15, .stiffness_N_per_m = 600.0, .damping_Ns_per_m = 15.0}},
    {"firm", {.mass_kg = 0.4, .stiffness_N_per_m = 1500.0, .damping_Ns_per_m = 30.0}},
};

struct Settings {
  std::vector<double> damping_Ns_per_m, rate_Hz, delay_s, step_m, friction_N;
  std::vector<Hand> hands{std::begin(kHands), std::end(kHands)};
};

Settings settings(Extent extent) {
  if (extent == Extent::kQuick)
    return {.damping_Ns_per_m = {0.5, 2.0, 10.0},
            .rate_Hz = {1000.0},
            .delay_s = {0.0, 1e-3},
            .step_m = {0.0, 24e-6},
            .friction_N = {0.0, 0.1},
            .hands = {kHands[0], kHands[2]}};
  return {.damping_Ns_per_m = {0.2, 0.5, 1.0, 2.0, 5.0, 10.0},
          .rate_Hz = {500.0, 1000.0, 2000.0, 4000.0},
          .delay_s = {0.0, 0.5e-3, 1e-3, 3e-3},
          .step_m = {0.0, 5e-6, 10e-6, 24e-6, 50e-6, 100e-6},
          .friction_N = {0.0, 0.02, 0.1, 0.3}};
}

Axes<6> axes(const Settings& s) {
  return {{s.rate_Hz.size(), s.delay_s.size(), s.friction_N.size(), s.hands.size(), s.step_m.size(),
           s.damping_Ns_per_m.size()}};
}

report::Row run(std::size_t job, Extent extent) {
  const Settings s = settings(extent);
  const auto [rate, delay, friction, hand, step, damping] = axes(s).at(job);
  LoopCase loop;
  loop.device = {.damping_Ns_per_m = s.damping_Ns_per_m[damping],
                 .friction_N = s.friction_N[friction],
                 .position_step_m = s.step_m[step],
                 .delay_s = s.delay_s[delay]};
  loop.rate_Hz = s.rate_Hz[rate];
  loop.hand = s.hands[hand].at_tool;
  const model::law::HapticLimit theory = model::law::haptic_limit(loop.device, loop.rate_Hz);
  const double grow_N_per_m = largest_wall_N_per_m(loop, Verdict::kGrow);
  LoopCase patient = loop;  // close to the line it rings for long
  patient.duration_s *= 3.0;
  const double rest_N_per_m = largest_wall_N_per_m(patient, Verdict::kBuzz);
  GateMonitor gate(loop.rate_Hz);
  // A cell may have no limit above zero; the gate still has to be tested there.
  const LoopRun gated = run_gated_wall(loop, 3.0 * std::max(grow_N_per_m, 1.0), gate);
  return {{"rate_Hz", loop.rate_Hz},
          {"delay_s", loop.device.delay_s},
          {"friction_N", loop.device.friction_N},
          {"hand", s.hands[hand].name},
          {"position_step_m", loop.device.position_step_m},
          {"damping_Ns_per_m", loop.device.damping_Ns_per_m},
          {"theory_grow_N_per_m", theory.grow_N_per_m},
          {"theory_safe_N_per_m", theory.safe_N_per_m()},
          {"largest_without_growth_N_per_m", grow_N_per_m},
          {"largest_at_rest_N_per_m", rest_N_per_m},
          {"gate_max_force_N", gate.max_force_N()},
          {"gate_max_step_N", gate.max_step_N()},
          {"gate_swing_m", gated.last_swing_m},
          {"beyond_the_line", gate.beyond_the_line()}};
}

}  // namespace

Map loop_map() {
  return {.letter = 'c',
          .name = "loop",
          .purpose = "largest stable wall over damping, rate, delay, encoder, friction, hand",
          .jobs = [](Extent extent) { return axes(settings(extent)).jobs(); },
          .run = run};
}

}  // namespace tact::tools::stability
