// SPDX-License-Identifier: Apache-2.0
// number_classes.h - classes of float for the gate's scalars: zero, denormals, normals, the limit
// and its neighbours, the largest, infinity, NaN, with both signs.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "model/types.h"

namespace tact::tests::numbers {

inline constexpr double kLimit = 8.0;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Doubles = std::numeric_limits<double>;

/// Ulps away from a number.
inline double beside(double x, int ulps) {
  for (int i = 0; i < std::abs(ulps); ++i) x = std::nextafter(x, ulps > 0 ? kInfinity : -kInfinity);
  return x;
}

inline std::vector<double> with_signs(std::vector<double> values) {
  const std::size_t n = values.size();
  for (std::size_t i = 0; i < n; ++i) values.push_back(-values[i]);
  return values;
}

inline std::vector<double> finite_classes() {
  return with_signs({0.0, Doubles::denorm_min(), beside(Doubles::min(), -1), Doubles::min(), 1e-160,
                     1.0, beside(kLimit, -1), kLimit, beside(kLimit, 1), 1e154, Doubles::max()});
}

inline std::vector<double> all_classes() {
  std::vector<double> values = finite_classes();
  for (const double odd : {kInfinity, -kInfinity, Doubles::quiet_NaN(), -Doubles::quiet_NaN()})
    values.push_back(odd);
  return values;
}

/// Calls f with every vector that has its components among these.
template <typename F>
void for_each_vector(const std::vector<double>& values, const F& f) {
  for (const double x : values)
    for (const double y : values)
      for (const double z : values) f(model::Vec3{x, y, z});
}

}  // namespace tact::tests::numbers
