// SPDX-License-Identifier: Apache-2.0
// stub_dhd_state.h - what the library's side and the test's side of the stand-in share.
#pragma once

#include <array>
#include <cstdlib>
#include <map>
#include <mutex>
#include <string>

#include "tests/support/led_handle.h"

namespace tact::tests::stub_dhd {

// Words of the status.
inline constexpr int kPower = 0, kConnected = 1, kStarted = 2, kForce = 5, kWristDetected = 8;
inline constexpr int kGravity = 10, kWristInit = 12, kForceOffCause = 14;

struct State {
  int count = 1, type = 63;
  bool open = false, expert = false;
  int pose_answer = 0, delay_us = 0;
  int watchdog = 0, time_guard = -1, gravity = 0;
  double force[7] = {};
  double turn[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  LedHandle handle;
  double fed_s = monotonic_s();
  double spin_radps = 0.0, strongest_N = 0.0, gripper_rad = 0.5236;
  unsigned buttons = 0;
  long switched_with_force = 0;
  std::array<int, 17> status{};
  std::map<int, int> fixed_status;
  std::map<std::string, int> failing;
  std::map<std::string, long> calls;

  State() {
    if (const char* wanted = std::getenv("TACT_STUB_DHD_TYPE")) type = std::atoi(wanted);
    status[kPower] = status[kConnected] = status[kStarted] = 1;
    status[kWristDetected] = status[kWristInit] = 1;
  }
};

extern std::mutex mutex;
extern State state;
extern bool watchdog_sleeps;  // through a reset

struct Locked {
  std::lock_guard<std::mutex> lock{mutex};
};

}  // namespace tact::tests::stub_dhd
