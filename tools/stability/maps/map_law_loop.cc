// SPDX-License-Identifier: Apache-2.0
// The closed haptic loop on every law: is its tangent stiffness what the wall's K is?
//
// Per cell one law, held at one depth of its range and shaken by a hair; its force is scaled by the
// largest factor without growth. If the theory of the wall carries over, factor times tangent is
// K_grow of model/law/haptic_limit.h, for any law. Of a law with memory the tangent is what
// one tick can meet: its nodes and terms give way later, which may only make it more stable.
#include <algorithm>
#include <memory>

#include "model/law/haptic_limit.h"
#include "tools/stability/laws/laws.h"
#include "tools/stability/loop/gate_monitor.h"
#include "tools/stability/loop/haptic_loop.h"
#include "tools/stability/sweep/axes.h"
#include "tools/stability/sweep/map.h"

namespace tact::tools::stability {
namespace {

struct Settings {
  std::vector<double> depth_ratio, damping_Ns_per_m, delay_s;
};

Settings settings(Extent extent) {
  if (extent == Extent::kQuick)
    return {.depth_ratio = {0.2, 0.7}, .damping_Ns_per_m = {1.0}, .delay_s = {0.5e-3}};
  return {.depth_ratio = {0.05, 0.2, 0.4, 0.6, 0.8, 0.95},
          .damping_Ns_per_m = {0.3, 1.0, 3.0},
          .delay_s = {0.0, 0.5e-3, 2e-3}};
}

Axes<4> axes(Extent extent) {
  const Settings s = settings(extent);
  return {
      {probed_laws().size(), s.delay_s.size(), s.damping_Ns_per_m.size(), s.depth_ratio.size()}};
}

/// New, and settled at the depth of balance.
TissueForce settled(const NamedLaw& named, double balance_m) {
  const auto tissue = std::make_shared<RenderedTissue>(named.fresh());
  tissue->settle(balance_m);
  return [tissue](double depth_m) { return tissue->tick(depth_m).force_N; };
}

/// The law three times stiffer than what is stable, every force through the gate.
void run_gated(const LoopCase& loop, const TissueForce& tissue, GateMonitor& gate) {
  LoopCase shaken = loop;
  // So large that the gate is put to the test.
  shaken.kick_m = 1e-3;
  // A law three times too stiff may ask for more than the gate may give.
  gate.open(std::min(tissue(loop.balance_m), kSceneLimits.force_N));
  run_loop(shaken, tissue, [&](double wanted_N, bool fresh) { return gate.step(wanted_N, fresh); });
}

report::Row run(std::size_t job, Extent extent) {
  const Settings s = settings(extent);
  const auto [which, delay, damping, depth] = axes(extent).at(job);
  const NamedLaw& named = probed_laws()[which];
  const double range_m = named.rendered_range_m;
  LoopCase loop;
  loop.device.damping_Ns_per_m = s.damping_Ns_per_m[damping];
  loop.device.delay_s = s.delay_s[delay];
  loop.balance_m = s.depth_ratio[depth] * range_m;
  // So small that the law is straight over it: then its tangent is the wall's K.
  loop.kick_m = 1e-4 * range_m;
  const TissueMaker fresh = [&] { return settled(named, loop.balance_m); };
  const double theory = model::law::haptic_limit(loop.device, loop.rate_Hz).grow_N_per_m;
  const double tangent = named.fresh().settle(loop.balance_m).stiffness_N_per_m;
  const double guess = theory / tangent;
  // far below the tangent of one tick a loop with memory is too slow for a run, far above still
  // holds
  const double low = named.remembers() ? 0.85 : 0.02, high = named.remembers() ? 500.0 : 50.0;
  const double factor = largest_factor(loop, fresh, Verdict::kGrow, low * guess, high * guess);
  // Settled again: each run of the search had one of its own.
  const TissueForce tissue = fresh();
  GateMonitor gate(loop.rate_Hz);
  run_gated(loop, [&](double depth_m) { return 3.0 * factor * tissue(depth_m); }, gate);
  // what the law as it is asks of the device at its steepest point
  const double needed = steepest_N_per_m(named) * (0.5 / loop.rate_Hz + loop.device.delay_s);
  return {{"law", named.name},
          {"delay_s", loop.device.delay_s},
          {"damping_Ns_per_m", loop.device.damping_Ns_per_m},
          {"depth_m", loop.balance_m},
          {"tangent_N_per_m", tangent},
          {"theory_grow_N_per_m", theory},
          {"largest_tangent_N_per_m", factor * tangent},
          {"measured_over_theory", factor * tangent / theory},
          {"damping_needed_Ns_per_m", needed},
          {"gate_max_force_N", gate.max_force_N()},
          {"gate_max_step_N", gate.max_step_N()},
          {"beyond_the_line", gate.beyond_the_line()}};
}

/// Which laws have memory: no column says it.
nlohmann::json facts() {
  nlohmann::json names = nlohmann::json::array();
  for (const NamedLaw& named : probed_laws())
    if (named.remembers()) names.push_back(named.name);
  return {{"with_memory", names}};
}

}  // namespace

Map law_loop_map() {
  return {.letter = 'c',
          .name = "loop_laws",
          .purpose = "largest stable tangent of every law, at depths of its range",
          .jobs = [](Extent extent) { return axes(extent).jobs(); },
          .run = run,
          .facts = facts};
}

}  // namespace tact::tools::stability
