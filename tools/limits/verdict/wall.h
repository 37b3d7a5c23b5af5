// SPDX-License-Identifier: Apache-2.0
// wall.h - how stiff a wall may be, without and with the passivity stage of the gate: Z-width.
//
// A wall F = K x, x below z = 0, is pressed by a light simulated hand (200 N/m) through the whole
// loop. K is raised by a quarter at a time from the device's own limit b / (T/2 + t_d)
// (model/law/haptic_limit.h). A motion grows when it swings wider in the last eighth of 4 s than in
// the third, by more than 2 % and beyond 0.1 mm; else it is bounded, which is less than at rest.
// Everything else of the gate works in both runs, so without the passivity stage a wall on which a
// motion grows bounces within force and slew limits.
#pragma once

#include <optional>
#include <vector>

#include "tools/limits/verdict/verdict.h"

namespace tact::tools::limits {

/// One stiffness, once with and once without the passivity stage.
struct WallRun {
  double early_swing_m = 0.0, last_swing_m = 0.0;  // peak to peak
  double given_energy_J = 0.0, force_N = 0.0;      // largest
  bool grows = false;
  bool in_bounds = true;  // of all limits that the gate had
};

struct WallPoint {
  double stiffness_N_per_m = 0.0;
  WallRun without, with;
};

struct WallVerdict {
  std::vector<WallPoint> points;  // ascending
  double theory_N_per_m = 0.0;    // of the device, without friction and hand
  // Bounded: largest up to which nothing grows. Rest: largest up to which every last swing is
  // 0.1 mm or less; a bounded motion may swing for ever. 0: none.
  double bounded_without_N_per_m = 0.0, bounded_with_N_per_m = 0.0;
  double rest_without_N_per_m = 0.0, rest_with_N_per_m = 0.0;
  double swing_without_m = 0.0, swing_with_m = 0.0;  // largest last swing, at any stiffness
  bool with_is_least = false;                        // the search ended before it grew
  std::vector<Check> checks;

  double bounded_ratio() const { return ratio(bounded_with_N_per_m, bounded_without_N_per_m); }
  double rest_ratio() const { return ratio(rest_with_N_per_m, rest_without_N_per_m); }
  static double ratio(double with, double without) { return without > 0.0 ? with / without : 0.0; }
  bool passed() const { return !checks.empty() && all_hold(checks); }
};

/// Without a value after Ctrl-C.
std::optional<WallVerdict> measure_wall(const LimitsBench& bench, const hal::DeviceInfo& device);

}  // namespace tact::tools::limits
