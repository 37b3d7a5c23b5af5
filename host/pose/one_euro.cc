// SPDX-License-Identifier: Apache-2.0
#include "host/pose/one_euro.h"

#include <numbers>

namespace tact::host::pose {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Rotation vector of the shorter way, rad.
Vector3d turn_between(const Quaterniond& from, const Quaterniond& to) {
  const Eigen::AngleAxisd turn(canonical(to * from.conjugate()));
  return turn.angle() * turn.axis();
}

double cutoff_Hz(const OneEuroSettings& settings, const Vector3d& speed_per_s) {
  // f_c = f_min + beta |x'|
  return settings.least_cutoff_Hz + settings.speed_gain_per_unit * speed_per_s.norm();
}

}  // namespace

double smoothing_share(double cutoff_Hz, double period_s) {
  // alpha = 1 / (1 + 1 / (2 pi f T))
  return 1.0 / (1.0 + 1.0 / (2.0 * std::numbers::pi * cutoff_Hz * period_s));
}

Pose PoseFilter::next(const Pose& raw, double time_s) {
  const double period_s = time_s - time_s_;
  const bool starts = !has_last_ || !(period_s > 0.0);
  time_s_ = time_s;
  has_last_ = true;
  if (starts) {
    velocity_mps_.setZero();
    turning_radps_.setZero();
    return last_ = raw;
  }
  // x' = low(x', (x - x_) / T, f_d)
  velocity_mps_ += smoothing_share(position_.speed_cutoff_Hz, period_s) *
                   ((raw.position_m - last_.position_m) / period_s - velocity_mps_);
  turning_radps_ += smoothing_share(rotation_.speed_cutoff_Hz, period_s) *
                    (turn_between(last_.rotation, raw.rotation) / period_s - turning_radps_);
  // x_ = low(x_, x, f_c)
  const double shift = smoothing_share(cutoff_Hz(position_, velocity_mps_), period_s);
  const double turn = smoothing_share(cutoff_Hz(rotation_, turning_radps_), period_s);
  last_ = {.rotation = between(last_, raw, turn).rotation,
           .position_m = between(last_, raw, shift).position_m};
  return last_;
}

}  // namespace tact::host::pose
