// SPDX-License-Identifier: Apache-2.0
// one_euro.h - smooths a pose for display without lag behind a fast hand: the one-euro filter [1].
//
//     x'  = low(x' , (x - x_) / T, f_d)          the speed, smoothed
//     f_c = f_min + beta |x'|                     the cutoff grows with it
//     x_  = low(x_, x, f_c)
//     low(a, b, f) = a + alpha (b - a),  alpha = 1 / (1 + 1 / (2 pi f T))
//
//     x  raw, m or rad     x_  filtered     T  time since the sample before, s, > 0
//     f_min, f_d, f_c  Hz     beta  1/m or 1/rad
//
// A position has the same alpha for its three axes, from the magnitude of its velocity. A rotation
// moves by the share alpha along the shorter way, and x' is its rotation vector over time.
//
// [1] G. Casiez, N. Roussel, D. Vogel, ACM CHI (2012) 2527-2530.
#pragma once

#include "host/pose/coordinate_chain.h"

namespace tact::host::pose {

struct OneEuroSettings {
  double least_cutoff_Hz = 1.0;      // f_min: a body at rest
  double speed_gain_per_unit = 0.0;  // beta
  double speed_cutoff_Hz = 1.0;      // f_d
};
inline constexpr OneEuroSettings kPositionFilter{.speed_gain_per_unit = 10.0};
inline constexpr OneEuroSettings kRotationFilter{.speed_gain_per_unit = 1.0};

/// alpha of the equations above, 0 to 1.
double smoothing_share(double cutoff_Hz, double period_s);

class PoseFilter {
 public:
  explicit PoseFilter(const OneEuroSettings& position = kPositionFilter,
                      const OneEuroSettings& rotation = kRotationFilter)
      : position_(position), rotation_(rotation) {}

  /// The filtered pose at `time_s`. The first pose, or one that is not later, is returned as it is.
  Pose next(const Pose& raw, double time_s);
  void reset() { has_last_ = false; }

 private:
  OneEuroSettings position_, rotation_;
  Pose last_{};
  Eigen::Vector3d velocity_mps_ = Eigen::Vector3d::Zero(), turning_radps_ = Eigen::Vector3d::Zero();
  double time_s_ = 0.0;
  bool has_last_ = false;
};

}  // namespace tact::host::pose
