// SPDX-License-Identifier: Apache-2.0
#include "hal/velocity_observer.h"

#include <cmath>
#include <numbers>

namespace tact::hal {

Vec3 VelocityObserver::step(const Vec3& position_m, double elapsed_s) RT_SAFE {
  if (!is_finite(position_m)) {
    reset();
    return {};
  }
  if (started_ && !(elapsed_s > 0.0)) return velocity_mps_;
  const Vec3 predicted_m = position_m_ + elapsed_s * velocity_mps_;
  const Vec3 residual_m = position_m - predicted_m;
  if (!started_) {
    started_ = true;
    position_m_ = position_m;
    return {};
  }
  // A hard start, a jump: no filter, so that it is never reported as slower than it was.
  const double q = norm(residual_m) <= jump_mps_ * elapsed_s
                       ? std::exp(-2.0 * std::numbers::pi * bandwidth_Hz_ * elapsed_s)
                       : 0.0;
  // x <- x- + (1 - q^2) r,  v <- v + (1 - q)^2 / T r
  position_m_ = predicted_m + (1.0 - q * q) * residual_m;
  velocity_mps_ += ((1.0 - q) * (1.0 - q) / elapsed_s) * residual_m;
  return velocity_mps_;
}

}  // namespace tact::hal
