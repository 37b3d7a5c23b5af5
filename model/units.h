// SPDX-License-Identifier: Apache-2.0
// units.h - human sizes for SI doubles: 2_mm is 0.002 m, 300_us is 0.0003 s, 20_deg is 0.349 rad.
#pragma once

#include <numbers>

namespace tact::model {

inline constexpr double kGravity_mps2 = 9.81;  // what hangs on a device weighs so much

constexpr double operator""_mm(long double v) { return static_cast<double>(v) * 1e-3; }
constexpr double operator""_mm(unsigned long long v) { return static_cast<double>(v) * 1e-3; }
constexpr double operator""_ms(long double v) { return static_cast<double>(v) * 1e-3; }
constexpr double operator""_ms(unsigned long long v) { return static_cast<double>(v) * 1e-3; }
constexpr double operator""_us(long double v) { return static_cast<double>(v) * 1e-6; }
constexpr double operator""_us(unsigned long long v) { return static_cast<double>(v) * 1e-6; }
constexpr double operator""_deg(long double v) {
  return static_cast<double>(v) * std::numbers::pi / 180.0;
}
constexpr double operator""_deg(unsigned long long v) {
  return static_cast<double>(v) * std::numbers::pi / 180.0;
}

}  // namespace tact::model
