// SPDX-License-Identifier: Apache-2.0
// thermal_limit.h - limits force by motor temperature: peak for a short time, RMS without end.
//
//     GT-4   thermal   dh/dt = (F^2 - h) / tau   h: square of the RMS of the force, first order
//                   A^2 = min(Fc^2 + kappa max(Fc^2 - h, 0), Fp^2),   kappa = 2 (Fp^2 / Fc^2 - 1)
//
//     F    written force, N    Fp  peak, N    Fc  continuous, N, <= Fp    tau  time constant, s
//
// The permitted force A is Fp up to h = Fc^2 / 2, then falls continuously to Fc at h = Fc^2. So
// RMS <= Fc for every input. Two conditions: (1 + kappa) T <= tau, T: period; and A falls no faster
// than the slew limit: kappa Fp^2 / (2 Fc tau) <= slew. A scene that breaks either is refused.
#pragma once

#include <cmath>

#include "model/limits.h"
#include "model/types.h"

namespace tact::firmware::gate {

/// For a force (N, N^2) or a torque (N m, (N m)^2): the gate has one of each.
class ThermalLimit {
 public:
  ThermalLimit(double peak, double continuous, double share_per_period)
      : peak_(peak),
        continuous_(continuous),
        continuous_squared_(continuous * continuous),
        steepness_(model::thermal_steepness(peak, continuous)),
        share_(share_per_period) {}

  /// A: the largest force that may be written now.
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
  /// RMS of the written force over tau.
  double rms() const RT_SAFE { return std::sqrt(mean_square_); }

 private:
  double peak_, continuous_, continuous_squared_, steepness_, share_;
  double mean_square_ = 0.0;  // h
};

}  // namespace tact::firmware::gate
