// SPDX-License-Identifier: Apache-2.0
// led_handle.h - the device behind a stand-in for a vendor SDK, frame W.
//
// A handle of 0.3 kg whose weight is balanced, led by a hand of 400 N/m and 12 N s/m down to
// z = -10 mm and back to 20 mm every 4 s. With TACT_STUB_GRIPS it grips on the way back. The
// physics runs when it is asked for, in steps of 0.25 ms of CLOCK_MONOTONIC.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <numbers>

namespace tact::tests {

inline double monotonic_s() noexcept {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct LedHandle {
  std::array<double, 3> position_m{0.0, 0.0, 0.02}, velocity_mps{};
  double begin_s = monotonic_s(), time_s = begin_s;
  bool held = false;

  /// To this moment; `force_N` gives the device's force on the handle at a time.
  template <typename Force>
  void catch_up(Force force_N) {
    constexpr double kStep_s = 0.25e-3, kMaxPhysics_s = 0.1;
    const double now_s = monotonic_s();
    time_s = std::max(time_s, now_s - kMaxPhysics_s);
    while (!held && time_s + kStep_s <= now_s) {
      time_s += kStep_s;
      step(kStep_s, force_N(time_s));
    }
  }
  /// From the lowest point until 0.5 s before the highest one.
  bool grips() const {
    const double phase_s = std::fmod(time_s - begin_s, kSwing_s);
    return std::getenv("TACT_STUB_GRIPS") != nullptr && phase_s >= 0.5 * kSwing_s &&
           phase_s < kSwing_s - 0.5;
  }
  void hold(double x_m, double y_m, double z_m) {
    held = true;
    position_m = {x_m, y_m, z_m};
  }

 private:
  static constexpr double kSwing_s = 4.0;

  void step(double dt_s, const std::array<double, 3>& device_N) {
    constexpr double kMass_kg = 0.3, kHand_N_per_m = 400.0, kHand_Ns_per_m = 12.0;
    const double swing =
        0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (time_s - begin_s) / kSwing_s);
    const double hand_m[3] = {0.0, 0.0, 0.02 - 0.03 * swing};
    for (std::size_t i = 0; i < 3; ++i) {
      const double total_N = device_N[i] + kHand_N_per_m * (hand_m[i] - position_m[i]) -
                             kHand_Ns_per_m * velocity_mps[i];
      velocity_mps[i] += dt_s * total_N / kMass_kg;
      position_m[i] += dt_s * velocity_mps[i];
    }
  }
};

}  // namespace tact::tests
