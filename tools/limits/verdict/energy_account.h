// SPDX-License-Identifier: Apache-2.0
// energy_account.h - what the device has given to the hand, by the record's own sums.
#pragma once

#include <algorithm>

#include "tools/limits/cases/case_run.h"

namespace tact::tools::limits {

inline constexpr double kRounding_ratio = 1.0 + 1e-9;  // for sums and products; |F| has none

/// Force that was held since the last sample, and the way that the next one shows.
class EnergyAccount {
 public:
  explicit EnergyAccount(const model::Limits& limits) : limits_(limits) {}

  void add(const TickRow& row, double period_s) {
    const double periods = 1.0 + row.skipped_periods;
    time_s_ += periods * period_s;
    // The force of the write before was on the hand until now, through every period that was
    // skipped.
    sum_.force_N += periods * held_.force_N;
    sum_.torque_Nm += periods * held_.torque_Nm;
    periods_ += periods;
    held_ = {.force_N = row.written_N, .torque_Nm = row.written_Nm};
    // Without a sample the way is not known: the force is added up until one comes.
    if (!row.fresh || !is_finite(row.tool)) return;
    if (placed_) {
      const Vec3 moved_m = row.tool.position_m - position_m_;
      given_J_ += dot(sum_.force_N, moved_m) / periods_ + turned_J(row.tool.orientation);
    }
    largest_J_ = std::max(largest_J_, given_J_);
    // The budget recovers with time, as the gate's does, but on a clock of its own.
    const double allowed_J = limits_.energy_J + limits_.recovery_W * time_s_;
    overdrawn_J_ = std::max(overdrawn_J_, given_J_ - allowed_J * kRounding_ratio);
    placed_ = true;
    position_m_ = row.tool.position_m;
    orientation_ = row.tool.orientation;
    sum_ = {};
    periods_ = 0.0;
  }
  double largest_J() const { return largest_J_; }
  double overdrawn_J() const { return overdrawn_J_; }

 private:
  double turned_J(const model::Quat& now) const {
    const model::Quat turn = now * conjugate(orientation_);
    const double sign = turn.w < 0.0 ? -2.0 : 2.0;  // small turns: twice the vector part
    return dot(sum_.torque_Nm, sign * Vec3{turn.x, turn.y, turn.z}) / periods_;
  }

  const model::Limits& limits_;
  Wrench held_, sum_;
  double periods_ = 0.0, time_s_ = 0.0;
  bool placed_ = false;
  Vec3 position_m_;
  model::Quat orientation_;
  double given_J_ = 0.0, largest_J_ = 0.0, overdrawn_J_ = 0.0;
};

}  // namespace tact::tools::limits
