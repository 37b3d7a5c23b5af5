// SPDX-License-Identifier: Apache-2.0
// Every law up to its limit and beyond, pressed and pulled through the gate.
//
// Per cell one law and one depth, in shares of its range: the force, tangent and status of the law
// there, and what the gate has written when a tool has come there from rest with 0.2 m/s, 1 kHz. Of
// a law with memory: what it gives when it has settled there.
#include <cmath>

#include "tools/stability/laws/laws.h"
#include "tools/stability/loop/gate_monitor.h"
#include "tools/stability/sweep/axes.h"
#include "tools/stability/sweep/map.h"

namespace tact::tools::stability {
namespace {

constexpr double kRate_Hz = 1000.0;
// Chosen: a quick press.
constexpr double kSpeed_mps = 0.2;

std::size_t depths(Extent extent) { return extent == Extent::kQuick ? 9 : 401; }

/// -1.5 .. 2.5 times the range.
double depth_share(std::size_t i, Extent extent) {
  return -1.5 + 4.0 * static_cast<double>(i) / static_cast<double>(depths(extent) - 1);
}

/// By model::law::LawStatus.
constexpr const char* kStatus[] = {"ok", "no contact", "saturated", "singular", "invalid"};

report::Row run(std::size_t job, Extent extent) {
  const auto [which, depth] = Axes<2>{{probed_laws().size(), depths(extent)}}.at(job);
  const NamedLaw& named = probed_laws()[which];
  const double range_m = named.range_m;
  const double share = depth_share(depth, extent), depth_m = share * range_m;
  // A new gate for each cell: cells are independent and computed on any thread.
  GateMonitor gate(kRate_Hz);
  gate.open(0.0);
  const int ticks = static_cast<int>(std::ceil(std::abs(depth_m) / kSpeed_mps * kRate_Hz));
  RenderedTissue tissue = named.fresh();
  for (int i = 1; i <= ticks; ++i) gate.step(tissue.tick(depth_m * i / ticks).force_N, true);
  // The law itself and not its table: the map is about the law's own limit.
  const model::law::LawResponse at =
      named.remembers() ? tissue.settle(depth_m) : named.law->respond(depth_m);
  // At the end of the range: forces and tangents of all laws come on one scale.
  const double edge_N = named.remembers() ? named.fresh().settle(range_m).force_N
                                          : named.law->respond(range_m).force_N;
  return {{"law", named.name},
          {"depth_ratio", share},
          {"depth_m", depth_m},
          {"force_N", at.force_N},
          {"force_ratio", at.force_N / edge_N},
          {"tangent_over_mean_ratio", at.stiffness_N_per_m * range_m / edge_N},
          {"status", kStatus[static_cast<std::size_t>(at.status)]},
          {"gate_force_N", gate.written_N()},
          {"gate_max_force_N", gate.max_force_N()},
          {"gate_max_step_N", gate.max_step_N()},
          {"gate", gate.kept_bounds() ? "in bounds" : "OUT OF BOUNDS"},
          {"beyond_the_line", named.beyond}};
}

}  // namespace

Map law_limit_map() {
  return {.letter = 'b',
          .name = "law_limits",
          .purpose = "every law pressed and pulled beyond its range, through the gate",
          .jobs = [](Extent extent) { return probed_laws().size() * depths(extent); },
          .run = run};
}

}  // namespace tact::tools::stability
