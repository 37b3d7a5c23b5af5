// SPDX-License-Identifier: Apache-2.0
// haptic_loop.h - one degree of freedom of a haptic loop: counted, sampled, late, held.
//
//     f_k  = F(x_k), x_k = D round(x(t_k) / D)                 the tissue, at counted depths
//     f(t) = f_k      for t_k + t_d <= t < t_(k+1) + t_d       held, t_d old
//
// The hand pushes with F(x_0), so that x_0 is the point of balance; the tool is let go one kick
// beside it. What happens then is the verdict:
//
//     rest   it comes to rest (with D > 0: the count is constant)
//     buzz   it keeps moving, by less than the kick: a few counts
//     grow   the motion grows
//
// Nothing here is shared with the loop that drives devices (firmware/), so the two can be compared.
#pragma once

#include <cstdint>
#include <functional>

#include "model/device_at_tool.h"

namespace tact::tools::stability {

/// What holds the tool.
struct HandAtTool {
  double mass_kg = 0.0;
  double stiffness_N_per_m = 0.0;
  double damping_Ns_per_m = 0.0;
};

struct LoopCase {
  model::DeviceAtTool device;
  double mass_kg = 0.3;  // of the device at the tool
  double rate_Hz = 1000.0;
  HandAtTool hand;
  double balance_m = 0.01;  // x_0
  double kick_m = 1e-3;     // let go this far from the balance
  double duration_s = 3.0;  // of the run
  double lost_share = 0.0;  // of ticks without a fresh sample: the force is held
  double late_share = 0.0;  // of ticks that eat late_periods more periods: the force is held
  int late_periods = 0;
  std::uint64_t seed = 1;  // of the chance in the last three
};

/// Force of the tissue at a counted depth, N; press positive, pushes out.
using TissueForce = std::function<double(double depth_m)>;
/// Makes such a tissue, settled at the balance: one with memory is new for each run.
using TissueMaker = std::function<TissueForce()>;
/// The stage between tissue and device, once per tick: the force written for the one wanted.
using Check = std::function<double(double wanted_N, bool fresh)>;

enum class Verdict { kRest, kBuzz, kGrow };

struct LoopRun {
  Verdict verdict = Verdict::kRest;
  double last_swing_m = 0.0;  // peak to peak, last third
  double max_force_N = 0.0;   // written
  double max_step_N = 0.0;    // written, from tick to tick
};

/// The depth nearest to `depth_m` where the count changes: the worst place to balance.
double between_counts_m(double depth_m, double position_step_m);

/// Ends early when the verdict is plain, unless `judge` is there: then every tick counts.
LoopRun run_loop(const LoopCase& loop, const TissueForce& tissue, const Check& check = nullptr);

/// Largest factor on the tissue's force, within [low, high], with a verdict better than `worse`:
/// bisection in the logarithm down to one percent; 0 if even `low` is too stiff.
double largest_factor(const LoopCase& loop, const TissueMaker& fresh, Verdict worse, double low,
                      double high);

/// The same for a wall F = K x: the largest K, N/m.
double largest_wall_N_per_m(const LoopCase& loop, Verdict worse);

}  // namespace tact::tools::stability
