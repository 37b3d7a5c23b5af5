// SPDX-License-Identifier: Apache-2.0
#include "tools/limits/verdict/wall.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/law/haptic_limit.h"

namespace tact::tools::limits {
namespace {

// Numbers of wall.h: eighths of 4 s, the third and the last; 2 %, 0.1 mm, a quarter at a time.
constexpr double kDuration_s = 4.0;
constexpr int kWindows = 8, kEarly = 2, kLast = 7;
constexpr double kMinGrowth_ratio = 1.02, kStill_m = 1e-4;
constexpr double kStiffnessStep_ratio = 1.25;
constexpr double kMaxStiffness_ratio = 500.0;  // times the device's own limit
constexpr int kBeyond = 10;  // points after the first that grows without the stage
constexpr double kMin_N_per_m = 50.0;

/// As good as no stage: no run has so much energy.
model::Limits without_passivity(const model::Limits& limits) {
  model::Limits open = limits;
  open.energy_J = 1e9;
  return open;
}

double swing_m(const std::vector<TickRow>& rows, int window) {
  // Turned round, beyond any device: a window without rows has no swing.
  double low_m = 1.0, high_m = -1.0;
  for (const TickRow& row : rows) {
    if (static_cast<int>(std::floor(row.t_s * kWindows / kDuration_s)) != window) continue;
    low_m = std::min(low_m, row.tool.position_m.z);
    high_m = std::max(high_m, row.tool.position_m.z);
  }
  return std::max(high_m - low_m, 0.0);
}

std::optional<WallRun> run_wall(double stiffness_N_per_m, const LimitsBench& bench, bool passive) {
  const Case wall{.name = "stiff-wall",
                  .what = "",
                  .shape = Shape::kWall,
                  .size = stiffness_N_per_m,
                  .hand = HandMove::kPress,
                  .duration_s = kDuration_s};
  LimitsBench here = bench;
  if (!passive) here.gate_limits = without_passivity;
  CaseRun run(wall, here);
  if (!run.play()) return std::nullopt;
  model::Limits limits = run.limits();
  // Evaluated by the limits that this run's gate had.
  if (!passive) limits = without_passivity(limits);
  const Extremes worst = extremes_of(run.rows(), limits, run.period_s());
  WallRun out{.early_swing_m = swing_m(run.rows(), kEarly),
              .last_swing_m = swing_m(run.rows(), kLast),
              .given_energy_J = worst.given_energy_J,
              .force_N = worst.force_N};
  out.grows =
      out.last_swing_m > kStill_m && out.last_swing_m > kMinGrowth_ratio * out.early_swing_m;
  out.in_bounds = all_hold(check_bounds(worst, limits, run.period_s()));
  return out;
}

bool grows(const WallRun& run) { return run.grows; }
bool moves(const WallRun& run) { return run.last_swing_m > kStill_m; }

/// The last stiffness before the first that `ends` it.
double last_before(const std::vector<WallPoint>& points, WallRun WallPoint::* which,
                   bool (*ends)(const WallRun&)) {
  double most = 0.0;
  for (const WallPoint& point : points) {
    if (ends(point.*which)) break;
    most = point.stiffness_N_per_m;
  }
  return most;
}

bool any_grows(const std::vector<WallPoint>& points, WallRun WallPoint::* which) {
  return std::ranges::any_of(points, grows, which);
}

double worst_swing_m(const std::vector<WallPoint>& points, WallRun WallPoint::* which) {
  double most = 0.0;
  for (const WallPoint& point : points) most = std::max(most, (point.*which).last_swing_m);
  return most;
}

void check(WallVerdict& v) {
  v.bounded_without_N_per_m = last_before(v.points, &WallPoint::without, grows);
  v.bounded_with_N_per_m = last_before(v.points, &WallPoint::with, grows);
  v.rest_without_N_per_m = last_before(v.points, &WallPoint::without, moves);
  v.rest_with_N_per_m = last_before(v.points, &WallPoint::with, moves);
  v.swing_without_m = worst_swing_m(v.points, &WallPoint::without);
  v.swing_with_m = worst_swing_m(v.points, &WallPoint::with);
  v.with_is_least = !any_grows(v.points, &WallPoint::with);
  const bool bounded = std::all_of(v.points.begin(), v.points.end(), [](const WallPoint& p) {
    return p.without.in_bounds && p.with.in_bounds;
  });
  const bool has_grown = any_grows(v.points, &WallPoint::without);
  v.checks = {
      {has_grown ? fmt::format("without the passivity stage the motion is bounded up to {:.0f} N/m",
                               v.bounded_without_N_per_m)
                 : std::string("no motion grew: the test had nothing to show"),
       has_grown && v.bounded_without_N_per_m > 0.0},
      {fmt::format("with it the motion is bounded up to {:.0f} N/m{}: {}{:.1f} times as stiff",
                   v.bounded_with_N_per_m, v.with_is_least ? ", the stiffest tried" : "",
                   v.with_is_least ? "at least " : "", v.bounded_ratio()),
       v.bounded_ratio() > 1.0},
      {fmt::format("the tool comes to rest up to {:.0f} N/m without the stage and up to {:.0f} N/m "
                   "with it: {:.1f} times as stiff",
                   v.rest_without_N_per_m, v.rest_with_N_per_m, v.rest_ratio()),
       v.rest_with_N_per_m >= v.rest_without_N_per_m},
      {fmt::format("largest swing of all: {:.2g} mm without the stage, {:.2g} mm with it",
                   1e3 * v.swing_without_m, 1e3 * v.swing_with_m),
       v.swing_with_m < v.swing_without_m},
      {bounded
           ? "force, slew, power and RMS stay in bounds at every stiffness, and energy with the "
             "stage"
           : "a limit was passed at some stiffness: column in_bounds of wall.csv",
       bounded}};
}

}  // namespace

std::optional<WallVerdict> measure_wall(const LimitsBench& bench, const hal::DeviceInfo& device) {
  WallVerdict v;
  if (device.at_tool)
    v.theory_N_per_m = model::law::haptic_limit(*device.at_tool, bench.scene.rate_Hz).grow_N_per_m;
  // Where theory is 0 (no damping) a product would never leave it.
  const double first = std::max(v.theory_N_per_m, kMin_N_per_m);
  int beyond = 0;
  for (double k = first; k < kMaxStiffness_ratio * first && beyond < kBeyond + 1;
       k *= kStiffnessStep_ratio) {
    const auto without = run_wall(k, bench, false);
    const auto with = without ? run_wall(k, bench, true) : std::nullopt;
    if (!with) return std::nullopt;
    v.points.push_back({.stiffness_N_per_m = k, .without = *without, .with = *with});
    // once it grows without the stage: on until it grows with it, but not for ever
    if (without->grows || beyond > 0) ++beyond;
    if (with->grows) break;
  }
  check(v);
  return v;
}

}  // namespace tact::tools::limits
