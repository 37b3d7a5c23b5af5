// SPDX-License-Identifier: Apache-2.0
// thermal_limit.h - motors bear their peak for a while and their continuous force for ever.
//
//     GT-4   heat   dh/dt = (F^2 - h) / tau   h: square of the RMS of the force, first order
//                   A^2 = min(Fc^2 + kappa max(Fc^2 - h, 0), Fp^2),   kappa = 2 (Fp^2 / Fc^2 - 1)
//
//     F    written force, N    Fp  peak, N    Fc  continuous, N, <= Fp    tau  time constant, s
//
// From half of the heat on the allowed force falls from Fp, and reaches Fc with the last of it: so
// RMS <= Fc for every input, without a step. That needs (1 + kappa) T <= tau, and a fall that the
// slew can follow: kappa Fp^2 / (2 Fc tau) <= slew. A scene that breaks either is refused.
#pragma once

#include <cmath>

#include "model/limits.h"
#include "model/types.h"

namespace tact::firmware::gate {

/// Of a force, in N and N^2, or of a torque, in N m and (N m)^2: the gate has one of each.
class ThermalLimit {
 public:
  ThermalLimit(double peak, double continuous, double share_per_period)
      : peak_(peak),
        continuous_(continuous),
        continuous_squared_(continuous * continuous),
        steepness_(model::thermal_steepness(peak, continuous)),
        share_(share_per_period) {}

  /// A: what may be written now.
  double allowed() const RT_SAFE {
    const double room = continuous_squared_ - mean_square_;
    const double squared = continuous_squared_ + steepness_ * std::fmax(room, 0.0);
    return squared < peak_ * peak_ ? std::sqrt(squared) : peak_;
  }
  /// GT-4 for a force or torque that was held for this many periods.
  void add(const model::Vec3& held, double periods) RT_SAFE {
    mean_square_ += std::fmin(share_ * periods, 1.0) * (dot(held, held) - mean_square_);
  }
  double continuous() const RT_SAFE { return continuous_; }
  /// Of what was written, over tau.
  double rms() const RT_SAFE { return std::sqrt(mean_square_); }

 private:
  double peak_, continuous_, continuous_squared_, steepness_, share_;
  double mean_square_ = 0.0;  // h
};

}  // namespace tact::firmware::gate
