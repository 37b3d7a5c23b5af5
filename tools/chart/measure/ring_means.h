// SPDX-License-Identifier: Apache-2.0
// ring_means.h - mean of a quantity along rings of a triangle surface around a point or an axis.
//
// The caller says how far each corner is from the middle; within a triangle distance and quantity
// are linear. Ring k is the line where the distance is k * pitch. Set-up code only.
#pragma once

#include <array>
#include <vector>

#include "model/types.h"

namespace tact::tools::chart {

/// Cosine of a triangle's normal with the site's: the others are the organ's far side.
inline constexpr double kFacing = 0.1;

class RingMeans {
 public:
  /// Rings 0 .. rings - 1; ring 0 is the middle itself, whose value the caller knows.
  RingMeans(int rings, double pitch_m, double middle_value);

  void add_triangle(const std::array<model::Vec3, 3>& corner_m,
                    const std::array<double, 3>& distance_m, const std::array<double, 3>& value);

  /// A ring that met no triangle has the value of the one before.
  std::vector<double> means() const;

 private:
  double pitch_m_;
  double middle_value_;
  std::vector<double> length_m_, sum_;
};

}  // namespace tact::tools::chart
