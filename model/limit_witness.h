// SPDX-License-Identifier: Apache-2.0
// limit_witness.h - did what was written to a device keep the limits of limits.h? It is for tests
// and for tools that evaluate a run. It sums by itself: nothing here asks the gate or shares its
// code.
//
//     |F| <= force_N     |T| <= torque_Nm     both zero unless armed and without a fault
//     |dF| <= slew_N_per_s t, t since the write before; |F| grows by one period's slew at most
//     F . v + T . w <= power_W                 zero within 10 ms of the second missed sample
//     sum of F_(k-1) . (x_k - x_(k-1)) <= energy_J + recovery_W t since arming (energy given),
//       and in any time t <= 2 energy_J + recovery_W t
//     RMS over thermal_time_s <= min(continuous_force_N, force_N); after periods that were skipped,
//       RMS^2 <= that^2 + force_N^2 (2 w + 10 ms) / thermal_time_s, w the longest hold of a force
//
// The torque keeps the same, in the proportion torque_Nm to force_N. Of missed samples the mean
// force counts along the way that the next one shows. firmware/gate/README.md has the exceptions.
#pragma once

#include <cstdint>

#include "model/limits.h"
#include "model/types.h"

namespace tact::model {

struct WrittenTick {
  Wrench written{};
  double written_grip_N = 0.0;  // on the fingers
  Tool tool{};                  // of the newest sample
  bool fresh = false;
  bool armed = false;
  bool faulted = false;               // a fault latches or is latched
  std::uint32_t skipped_periods = 0;  // between the tick before and this one
};

/// That a tick gives to the hand.
double given_power_W(const Wrench& w, const Tool& tool);

/// The largest values of all ticks so far.
struct LimitExtremes {
  double force_N = 0.0, torque_Nm = 0.0, power_W = 0.0;
  double step_N = 0.0, step_Nm = 0.0;  // for each period that passed since the write before
  double given_energy_J = 0.0;         // since arming
  double overdrawn_J = 0.0;            // above budget and recovery; 0: never
  double rms_N = 0.0, rms_Nm = 0.0;
  double grip_N = 0.0;
};

class LimitWitness {
 public:
  /// For sums and products of many rounded numbers; |F| has none.
  static constexpr double kRounding_ratio = 1.0 + 1e-9;

  /// `limits` as they act here: limits_in_use().
  LimitWitness(const Limits& limits, double period_s);

  /// One tick. The limit that it broke, or null.
  const char* check(const WrittenTick& tick);

  const LimitExtremes& worst() const { return worst_; }
  void forget_worst() { worst_ = {}; }
  double force_step_N() const { return step_N_; }  // of one period
  /// Since arming; below zero: more was taken.
  double total_given_energy_J() const { return given_energy_J_; }
  /// Since arming no step was longer than its time allows, and no period was skipped.
  bool is_motion_permitted() const { return is_permitted_; }
  std::uint64_t missed_samples() const { return missed_samples_; }
  /// Where a force is allowed for ever; 0: none is allowed and none was written.
  double rms_ratio() const { return ratio(worst_.rms_N, continuous_N_); }
  double rms_torque_ratio() const { return ratio(worst_.rms_Nm, continuous_N_ * lever_m_); }

 private:
  static double ratio(double rms, double most) { return rms > 0.0 ? rms / most : 0.0; }
  double max_given_energy_J() const;
  void add_energy(const WrittenTick& tick, double periods);
  void add_thermal(double periods);
  void keep_worst(const WrittenTick& tick, double periods, bool stopped);
  const char* broken_peak(const WrittenTick& tick, bool stopped) const;
  const char* broken_step(const WrittenTick& tick, double periods, bool stopped) const;
  const char* broken_thermal() const;
  const char* broken_energy(bool stopped) const;
  void disarm();

  Limits limits_;
  double period_s_, lever_m_, continuous_N_, step_N_;
  LimitExtremes worst_;
  Wrench before_;
  bool was_armed_ = false;
  double mean_square_N2_ = 0.0, torque_mean_square_N2m2_ = 0.0;
  bool is_overheated_ = false;  // a force was held for longer than could be known
  double longest_s_ = 0.0;      // that one was held meanwhile
  double given_energy_J_ = 0.0, lately_J_ = 0.0;
  std::uint64_t missed_samples_ = 0;              // in a row, one a period
  std::uint64_t periods_ = 0, held_periods_ = 0;  // since arming; since the last sample
  Wrench held_;                                   // sum of each period's since the last sample
  bool is_placed_ = false, is_paused_ = false, is_permitted_ = true;
  Vec3 position_m_;
  Quat orientation_;
};

}  // namespace tact::model
