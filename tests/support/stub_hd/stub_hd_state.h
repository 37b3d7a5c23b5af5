// SPDX-License-Identifier: Apache-2.0
// stub_hd_state.h - what the library's side and the test's side of the stand-in share.
#pragma once

#include <unistd.h>

#include <array>
#include <atomic>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "tests/support/led_handle.h"

namespace tact::tests::stub_hd {

// Of the device's frame; their middle is the origin of W.
inline constexpr std::array<double, 6> kBox_mm{-80.0, -50.0, -30.0, 80.0, 70.0, 40.0};
inline constexpr std::array<double, 3> kMiddle_mm{0.0, 10.0, 5.0};

/// The device's axes: x is y of W, y is z, z is x.
inline std::array<double, 3> to_device_mm(const std::array<double, 3>& w_m) {
  return {1e3 * w_m[1] + kMiddle_mm[0], 1e3 * w_m[2] + kMiddle_mm[1], 1e3 * w_m[0] + kMiddle_mm[2]};
}

struct State {
  bool open = false, output = false, output_lost = false, in_frame = false;
  unsigned calibration = 0x5000;  // is calibrated
  long frame_of_cycle = -1;
  bool opens_anyway = false;
  bool bad_frame = false;  // a force may not follow
  long unsafe_calls = 0;   // stub_hd.h
  int delay_us = 0;
  std::array<double, 3> set_N{}, force_N{};  // of the device's frame
  double strongest_N = 0.0, spin_radps = 0.0, lean_rad = 0.0;
  bool turned = false;
  std::array<double, 12> turn{};  // columns of the stylus' axes
  LedHandle handle;
  std::vector<unsigned> errors;
  std::string name, serial = std::to_string(getpid());
  std::map<unsigned, double> numbers;  // that a test has set
  std::map<std::string, unsigned> failing;
  std::map<std::string, long> calls;
};

/// What a Touch reports of itself.
inline double number_of_touch(unsigned what) {
  switch (what) {
    case 0x2553:  // input degrees of freedom
      return 6;
    case 0x2555:  // calibrated in the inkwell
      return 4;
    case 0x2602:  // N/mm
      return 0.5;
    case 0x2603:  // N
      return 3.3;
    case 0x2604:  // N, for long
      return 0.88;
    default:
      return 0.0;
  }
}

extern std::mutex mutex;
extern State state;
extern std::atomic<bool> silent;  // the scheduler

struct Locked {
  std::lock_guard<std::mutex> lock{mutex};
};

}  // namespace tact::tests::stub_hd
