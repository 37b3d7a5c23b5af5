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

/// Chosen: five quanta of 0.0236 mm at 4 kHz, and no hand's next millisecond.
inline constexpr double kJump_mps = 0.5, kJump_radps = 10.0;

class VelocityObserver {
 public:
  /// Where a step differs from the prediction by more than jump_mps, v is the whole step over T.
  VelocityObserver(double bandwidth_Hz, double jump_mps)
      : bandwidth_Hz_(bandwidth_Hz), jump_mps_(jump_mps) {}

  /// Velocity after a sample taken elapsed_s after the one before. A first sample or a NaN gives
  /// zero; elapsed_s of zero keeps the last value.
  Vec3 step(const Vec3& position_m, double elapsed_s) RT_SAFE;

  void reset() RT_SAFE { started_ = false, velocity_mps_ = {}; }

 private:
  double bandwidth_Hz_;
  double jump_mps_;
  bool started_ = false;
  Vec3 position_m_;
  Vec3 velocity_mps_;
};

}  // namespace tact::hal
