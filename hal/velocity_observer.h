// SPDX-License-Identifier: Apache-2.0
// velocity_observer.h - velocity from counted positions: a two-pole tracking observer, per axis.
//
//     x- = x + T v,   r = z - x-,   x <- x- + (1 - q^2) r,   v <- v + (1 - q)^2 / T r
//     q = exp(-w T),  w = 2 pi f        =>   v(z)/x(z) = (1 - q)^2 / T  z (z - 1) / (z - q)^2
//
//     z  measured position, m (or rad);   x, v  estimates;   T  time since the last sample, s
//     f  bandwidth, Hz: both poles at w, so v is the true velocity through (w / (s + w))^2
//
// Constant velocity is tracked without bias at any T, even when T changes from sample to sample; a
// change of velocity arrives with a delay of 2/w. One quantum D of the encoder disturbs v by at
// most w D / e: 1.6 mm/s for 0.0236 mm at 30 Hz, where the difference of two samples 1 ms apart
// gives 24 mm/s. Alpha-beta filter of P. Kalata (IEEE T-AES 20, 1984, 174) with equal poles.
#pragma once

#include "model/types.h"

namespace tact::hal {

using model::Vec3;

class VelocityObserver {
 public:
  /// A step larger than jump_m between prediction and sample is a new start, not a motion.
  VelocityObserver(double bandwidth_Hz, double jump_m)
      : bandwidth_Hz_(bandwidth_Hz), jump_m_(jump_m) {}

  /// Velocity after a sample taken elapsed_s after the one before. A first sample, a jump or a NaN
  /// gives zero; elapsed_s of zero keeps the last value.
  Vec3 step(const Vec3& position_m, double elapsed_s) RT_SAFE;

  void reset() RT_SAFE { started_ = false, velocity_mps_ = {}; }

 private:
  double bandwidth_Hz_;
  double jump_m_;
  bool started_ = false;
  Vec3 position_m_;
  Vec3 velocity_mps_;
};

}  // namespace tact::hal
