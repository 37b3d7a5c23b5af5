// wall.h - how stiff a wall may be, without and with the passivity stage of the gate: Z-width.
//
// A wall F = K x, x below z = 0, is pressed by a light simulated hand (200 N/m) through the whole
// loop. K is raised by a quarter at a time from the device's own limit b / (T/2 + t_d)
// (model/haptic_limit.h). A motion grows when it swings wider in the last eighth of 4 s than in the
// third, by more than 2 % and beyond 0.1 mm. Everything else of the gate works in both runs, so
// without the passivity stage an unstable wall bounces within force and slew limits.
#pragma once

#include <optional>
#include <vector>

#include "tools/limits/verdict.h"

namespace tact::tools {

/// One stiffness, once with and once without the passivity stage.
struct WallRun {
  double early_swing_m = 0.0, last_swing_m = 0.0;  // peak to peak
  double given_J = 0.0, force_N = 0.0;             // largest
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
  double without_N_per_m = 0.0;   // largest below which nothing grows; 0: none
  double with_N_per_m = 0.0;
  double rest_N_per_m = 0.0;   // largest below which everything comes to rest, with the stage
  bool with_is_least = false;  // the search ended before it grew
  std::vector<Check> checks;

  double ratio() const { return without_N_per_m > 0.0 ? with_N_per_m / without_N_per_m : 0.0; }
  bool passed() const;
};

/// Without a value after Ctrl-C.
std::optional<WallVerdict> measure_wall(const LimitsBench& bench, const hal::DeviceInfo& device);

}  // namespace tact::tools
