// SPDX-License-Identifier: Apache-2.0
// energy_ledger.h - what the written wrench has given and how far it has warmed, from the records
// alone: nothing that the gate says of itself is asked.
#pragma once

#include <algorithm>
#include <cmath>

#include "hal/device.h"
#include "model/types.h"

namespace tact::soak {

/// The mean force between two fresh samples times the way between them; so with torque.
class EnergyAccount {
 public:
  void add(const model::Wrench& held, double passed_s, const hal::Sample& sample,
           double recovery_W) {
    impulse_.force_N += passed_s * held.force_N;
    impulse_.torque_Nm += passed_s * held.torque_Nm;
    since_sample_s_ += passed_s;
    time_s_ += passed_s;
    if (!sample.fresh || !is_finite(sample.tool)) return;
    if (placed_) {
      const model::Quat turn = sample.tool.orientation * conjugate(orientation_);
      const double twice = turn.w < 0.0 ? -2.0 : 2.0;  // small turns: twice the vector part
      const double done_J = (dot(impulse_.force_N, sample.tool.position_m - position_m_) +
                             dot(impulse_.torque_Nm, twice * model::Vec3{turn.x, turn.y, turn.z})) /
                            since_sample_s_;
      given_energy_J_ += done_J;
      lately_J_ = std::max(lately_J_ + done_J - recovery_W * since_sample_s_, 0.0);
    }
    placed_ = true;
    position_m_ = sample.tool.position_m;
    orientation_ = sample.tool.orientation;
    impulse_ = {};
    since_sample_s_ = 0.0;
  }
  void restart() { *this = {}; }

  double total_given_energy_J() const { return given_energy_J_; }
  /// The most of any stretch of time that ends now, less what came back in it.
  double lately_J() const { return lately_J_; }
  double time_s() const { return time_s_; }

 private:
  model::Wrench impulse_;  // N s, N m s
  double since_sample_s_ = 0.0, time_s_ = 0.0;
  double given_energy_J_ = 0.0, lately_J_ = 0.0;
  bool placed_ = false;
  model::Vec3 position_m_;
  model::Quat orientation_;
};

/// First order, as motors warm: dh/dt = (F^2 - h) / tau.
class ThermalLedger {
 public:
  void add(const model::Vec3& held, double share) {
    mean_square_ += share * (dot(held, held) - mean_square_);
  }
  double rms() const { return std::sqrt(mean_square_); }

 private:
  double mean_square_ = 0.0;
};

}  // namespace tact::soak
