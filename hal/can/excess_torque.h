// SPDX-License-Identifier: Apache-2.0
// excess_torque.h - torque that a drive measures beyond what it was commanded: an offset or
// an integral term of its own, a wrong calibration, another controller in it.
//
//     e    = T - nearest of [min, max] of 0 and the last three commands     N m
//     mean = mean + kShare_ratio (e - mean)                                      one step a sample
//
// Less than commanded is a limit of the drive. Three commands: a sample is up to two periods old.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "model/rt.h"

namespace tact::hal::can {

/// Share of a motor's largest torque; chosen: above friction and ripple, below what moves a hand.
inline constexpr double kMaxExcess_ratio = 0.1;

class ExcessTorque {
 public:
  /// Each tick, with what is sent.
  void command(double torque_Nm) RT_SAFE {
    commanded_Nm_ = {torque_Nm, commanded_Nm_[0], commanded_Nm_[1]};
  }
  /// Each sample. Not powered: the mean begins again.
  void measure(double torque_Nm, bool powered) RT_SAFE {
    double least_Nm = 0.0, most_Nm = 0.0;
    for (const double each_Nm : commanded_Nm_) {
      least_Nm = std::min(least_Nm, each_Nm);
      most_Nm = std::max(most_Nm, each_Nm);
    }
    const double near_Nm = std::clamp(torque_Nm, least_Nm, most_Nm);
    mean_Nm_ = powered ? mean_Nm_ + kShare_ratio * (torque_Nm - near_Nm - mean_Nm_) : 0.0;
  }
  double mean_Nm() const RT_SAFE { return mean_Nm_; }
  /// Also when it is not a number.
  bool exceeds(double limit_Nm) const RT_SAFE { return !(std::abs(mean_Nm_) <= limit_Nm); }

 private:
  static constexpr double kShare_ratio = 0.02;  // 50 ms at 1 kHz

  std::array<double, 3> commanded_Nm_{};
  double mean_Nm_ = 0.0;
};

}  // namespace tact::hal::can
