// SPDX-License-Identifier: Apache-2.0
#include "tools/stability/loop/haptic_loop.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/stability/loop/loop_plant.h"
#include "tools/stability/loop/random.h"

namespace tact::tools::stability {
namespace {

constexpr double kMaxKick_ratio = 20.0;  // times the kick: it grows for any further motion
// More than DelayLine holds: no other force is still on its way.
constexpr int kStillTicks = 200;

/// Forces on their way to the device.
class DelayLine {
 public:
  DelayLine(double delay_s, double period_s)
      // A delay of whole periods must not lose one by rounding.
      : periods_(static_cast<std::size_t>(delay_s / period_s + 1e-9)),
        rest_s_(std::max(0.0, delay_s - static_cast<double>(periods_) * period_s)) {
    if (rest_s_ < 1e-9 * period_s) rest_s_ = 0.0;
    // before_N() looks one further back.
    periods_ = std::min(periods_, kMax - 2);
  }
  void fill(double force_N) { force_N_.fill(force_N); }
  void push(double force_N) {
    newest_ = (newest_ + 1) % kMax;
    force_N_[newest_] = force_N;
  }
  /// Part of a period in which the force before still acts.
  double rest_s() const { return rest_s_; }
  double acting_N() const { return force_N_[(newest_ + kMax - periods_) % kMax]; }
  double before_N() const { return force_N_[(newest_ + kMax - periods_ - 1) % kMax]; }

 private:
  static constexpr std::size_t kMax = 128;
  std::array<double, kMax> force_N_{};
  std::size_t newest_ = 0;
  std::size_t periods_;
  double rest_s_;
};

/// Smallest and largest deviation, and whether the count stood still.
struct Window {
  double low_m = 0.0, high_m = 0.0;
  bool moved = false;
  bool started = false;

  void add(double y_m, bool count_changed) {
    low_m = started ? std::min(low_m, y_m) : y_m;
    high_m = started ? std::max(high_m, y_m) : y_m;
    moved = moved || count_changed;
    started = true;
  }
  double swing_m() const { return high_m - low_m; }
};

double counted_m(double depth_m, double step_m) {
  return step_m > 0.0 ? step_m * std::round(depth_m / step_m) : depth_m;
}

/// Which ticks bring a new force.
class Luck {
 public:
  explicit Luck(const LoopCase& loop) : loop_(loop), random_(loop.seed) {}
  /// True if this tick does not take place: a late one before it has eaten it.
  bool skips() {
    // The late tick itself takes place; those that it eats come after it.
    if (eaten_ > 0) return --eaten_, true;
    if (loop_.late_share > 0.0 && random_.uniform() < loop_.late_share) eaten_ = loop_.late_periods;
    return false;
  }
  bool fresh() { return !(loop_.lost_share > 0.0) || random_.uniform() >= loop_.lost_share; }

 private:
  const LoopCase& loop_;
  Random random_;
  int eaten_ = 0;
};

/// Device and hand as one mass.
LoopPlant plant_of(const LoopCase& loop) {
  return LoopPlant({.mass_kg = loop.mass_kg + loop.hand.mass_kg,
                    .damping_Ns_per_m = loop.device.damping_Ns_per_m + loop.hand.damping_Ns_per_m,
                    .stiffness_N_per_m = loop.hand.stiffness_N_per_m,
                    .friction_N = loop.device.friction_N});
}

/// One period, in which two forces act in turn: the delay is no whole number of periods.
void move(LoopPlant& plant, const DelayLine& line, double push_N, double period_s) {
  if (line.rest_s() > 0.0) plant.move(push_N - line.before_N(), line.rest_s());
  plant.move(push_N - line.acting_N(), period_s - line.rest_s());
}

Verdict verdict_of(const Window& first, const Window& last, bool counts) {
  // Thirds of the run: close to the line one swing hardly differs from the next.
  if (last.swing_m() > first.swing_m()) return Verdict::kGrow;
  return counts && last.moved ? Verdict::kBuzz : Verdict::kRest;
}

}  // namespace

double between_counts_m(double depth_m, double position_step_m) {
  if (!(position_step_m > 0.0)) return depth_m;
  // Counts are rounded, so they change half-way between two.
  return position_step_m * (std::floor(depth_m / position_step_m) + 0.5);
}

LoopRun run_loop(const LoopCase& loop, const TissueForce& tissue, const Check& check) {
  const double period_s = 1.0 / loop.rate_Hz;
  const double step_m = loop.device.position_step_m;
  LoopPlant plant = plant_of(loop);
  const double push_N = tissue(loop.balance_m);
  plant.place(loop.kick_m);
  DelayLine line(loop.device.delay_s, period_s);
  // As if it had stood at the balance for long: the first forces are in balance with the hand.
  line.fill(push_N);
  Luck luck(loop);
  LoopRun run;
  Window first, last;
  const int ticks = static_cast<int>(loop.duration_s * loop.rate_Hz);
  double written_N = push_N, wanted_N = push_N, count_m = 0.0;
  int still = 0;
  for (int k = 0; k < ticks; ++k) {
    if (!luck.skips()) {
      const bool fresh = luck.fresh();
      if (fresh) {
        const double now_m = counted_m(loop.balance_m + plant.position_m(), step_m);
        wanted_N = tissue(now_m);
        if (3 * k < ticks) first.add(plant.position_m(), now_m != count_m);
        if (3 * k >= 2 * ticks) last.add(plant.position_m(), now_m != count_m);
        count_m = now_m;
      }
      // A lost sample holds the force; the gate gets the loss, and ramps it down.
      const double force_N = check ? check(wanted_N, fresh) : wanted_N;
      if (k > 0) run.max_step_N = std::max(run.max_step_N, std::abs(force_N - written_N));
      run.max_force_N = std::max(run.max_force_N, std::abs(force_N));
      written_N = force_N;
    }
    line.push(written_N);
    move(plant, line, push_N, period_s);
    // The gate's extremes may come at any time, so such a run has no early end.
    if (check) continue;
    still = plant.is_stuck() ? still + 1 : 0;
    if (still > kStillTicks) return run;  // at rest for good
    if (!(std::abs(plant.position_m()) < kMaxKick_ratio * loop.kick_m)) {
      run.verdict = Verdict::kGrow;
      return run;
    }
  }
  run.last_swing_m = last.swing_m();
  run.verdict = verdict_of(first, last, step_m > 0.0);
  return run;
}

double largest_factor(const LoopCase& loop, const TissueMaker& fresh, Verdict worse, double low,
                      double high) {
  const auto holds = [&](double factor) {
    // One with memory would begin where the run before has left it.
    const TissueForce tissue = fresh();
    return run_loop(loop, [&](double depth_m) { return factor * tissue(depth_m); }).verdict < worse;
  };
  if (!holds(low)) return 0.0;
  if (holds(high)) return high;
  // In the logarithm: a wall's limit may lie anywhere between 1 and 1e7 N/m.
  while (high / low > 1.01) {
    const double middle = std::sqrt(low * high);
    (holds(middle) ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

double largest_wall_N_per_m(const LoopCase& loop, Verdict worse) {
  LoopCase at = loop;
  at.balance_m = between_counts_m(loop.balance_m, loop.device.position_step_m);
  const TissueForce wall = [](double depth_m) { return depth_m; };  // 1 N/m
  return largest_factor(at, [&wall] { return wall; }, worse, 1.0, 1e7);
}

}  // namespace tact::tools::stability
