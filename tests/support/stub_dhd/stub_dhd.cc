// SPDX-License-Identifier: Apache-2.0
// stub_dhd.cc - a library with the symbols of Force Dimension's, for PCs without it: a stand-in for
// tests and for the bench (device.force_dimension.library = ".../libtact-stub-dhd.so").
//
// Behind it a delta.3, led by a hand (led_handle.h). Forces are cut by the watchdog as the device
// cuts them. Each process has a device of its own, as TACT_STUB_DHD_SERIAL or its pid numbers it.
// With TACT_STUB_DHD_NO_WATCHDOG it bears a PC that stalls; at its end it writes to the descriptor
// TACT_STUB_DHD_END whether the force is off.
#include "tests/support/stub_dhd/stub_dhd.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <string>

#include "tests/support/stub_dhd/stub_dhd_state.h"

namespace tact::tests::stub_dhd {

std::mutex mutex;
State state;
bool watchdog_sleeps = std::getenv("TACT_STUB_DHD_NO_WATCHDOG") != nullptr;

}  // namespace tact::tests::stub_dhd

namespace {

using namespace tact::tests::stub_dhd;
using tact::tests::monotonic_s;

constexpr double kWatchdogUnit_s = 125e-6;
constexpr int kErrorCode = 1, kNotEnabled = 9, kBadId = 15;
constexpr int kCausedByWatchdog = 3, kCausedBySoftware = 4;

thread_local int last_error = 0;

/// At a regular end: what the motors are left with. Twice, as a test may let one call fail.
struct End {
  End() = default;
  End(const End&) = delete;
  End& operator=(const End&) = delete;
  ~End() {
    const char* to = std::getenv("TACT_STUB_DHD_END");
    for (int i = 0; to != nullptr && i < 2; ++i)
      dprintf(std::atoi(to), state.status[kForce] != 0 ? "force on\n" : "force off\n");
  }
};
const End at_the_end;

/// Counts the call; the error that it must give, or 0.
int enter(const char* function) {
  ++state.calls[function];
  const auto found = state.failing.find(function);
  last_error = found == state.failing.end() ? 0 : found->second;
  return last_error == 0 ? 0 : -1;
}

void watch(double time_s) {
  if (!watchdog_sleeps && state.watchdog > 0 && state.status[kForce] != 0 &&
      time_s - state.fed_s > kWatchdogUnit_s * state.watchdog) {
    state.status[kForce] = 0;
    state.status[kForceOffCause] = kCausedByWatchdog;
  }
}

void catch_up() {
  state.handle.catch_up([](double time_s) {
    watch(time_s);
    const double* f = state.force;
    return state.status[kForce] != 0 ? std::array{f[0], f[1], f[2]} : std::array<double, 3>{};
  });
}

}  // namespace

extern "C" {

// NOLINTBEGIN(readability-identifier-naming): the vendor's names
int dhdGetDeviceCount() {
  const Locked locked;
  return enter("dhdGetDeviceCount") < 0 ? -1 : state.count;
}

int dhdOpenID(char index) {
  const Locked locked;
  if (enter("dhdOpenID") < 0) return -1;
  if (index < 0 || index >= state.count) return last_error = kBadId, -1;
  state.open = true;
  return index;
}

int dhdClose(char) {
  const Locked locked;
  state.open = false;
  state.status[kForce] = 0;
  return enter("dhdClose");
}

int dhdStop(char) {
  const Locked locked;
  state.status[kForce] = 0;
  return enter("dhdStop");
}

int dhdGetSystemType(char) {
  const Locked locked;
  return enter("dhdGetSystemType") < 0 ? -1 : state.type;
}

int dhdGetSerialNumber(unsigned short* number, char) {
  const Locked locked;
  const char* wanted = std::getenv("TACT_STUB_DHD_SERIAL");
  *number = wanted != nullptr ? static_cast<unsigned short>(std::atoi(wanted))
                              : static_cast<unsigned short>(1 + getpid() % 60'000);
  return enter("dhdGetSerialNumber");
}

int dhdGetStatus(int words[17], char) {
  const Locked locked;
  if (enter("dhdGetStatus") < 0) return -1;
  catch_up();
  state.status[kGravity] = state.gravity;
  std::copy(state.status.begin(), state.status.end(), words);
  for (const auto& [word, value] : state.fixed_status) words[word] = value;
  return 0;
}

int dhdGetPositionAndOrientationFrame(double* x_m, double* y_m, double* z_m, double r[3][3], char) {
  int delay_us = 0;
  {
    const Locked locked;
    delay_us = state.delay_us;
  }
  if (delay_us > 0) usleep(static_cast<useconds_t>(delay_us));
  const Locked locked;
  if (enter("dhdGetPositionAndOrientationFrame") < 0) return -1;
  catch_up();
  *x_m = state.handle.position_m[0], *y_m = state.handle.position_m[1];
  *z_m = state.handle.position_m[2];
  const double angle_rad = state.spin_radps * (monotonic_s() - state.handle.begin_s);
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const double frame[3][3] = {{c, -s, 0.0}, {s, c, 0.0}, {0.0, 0.0, 1.0}};
  const auto& shown = state.spin_radps != 0.0 ? frame : state.turn;
  std::copy(&shown[0][0], &shown[0][0] + 9, &r[0][0]);
  return state.pose_answer;
}

int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty,
                                        double tz, double grip, char) {
  const Locked locked;
  if (enter("dhdSetForceAndTorqueAndGripperForce") < 0) return -1;
  catch_up();
  const double force[7] = {fx, fy, fz, tx, ty, tz, grip};
  std::copy(force, force + 7, state.force);
  state.fed_s = monotonic_s();
  if (state.status[kForce] != 0)
    state.strongest_N = std::max(state.strongest_N, std::hypot(fx, fy, fz));
  return 0;
}

int dhdEnableForce(unsigned char on, char) {
  const Locked locked;
  if (enter("dhdEnableForce") < 0) return -1;
  catch_up();
  const auto is_set = [](double part) { return part != 0.0; };
  if (std::any_of(state.force, state.force + 7, is_set)) ++state.switched_with_force;
  state.status[kForce] = on != 0 ? 1 : 0;
  state.status[kForceOffCause] = on != 0 ? 0 : kCausedBySoftware;
  state.fed_s = monotonic_s();
  return 0;
}

int dhdSetGravityCompensation(int on, char) {
  const Locked locked;
  state.gravity = on;
  return enter("dhdSetGravityCompensation");
}

int dhdEnableExpertMode() {
  const Locked locked;
  state.expert = true;
  return enter("dhdEnableExpertMode");
}

int dhdSetTimeGuard(int us, char) {
  const Locked locked;
  if (!state.expert) return last_error = kNotEnabled, -1;
  state.time_guard = us;
  return enter("dhdSetTimeGuard");
}

int dhdSetWatchdog(unsigned char duration_125us, char) {
  const Locked locked;
  if (!state.expert) return last_error = kNotEnabled, -1;
  state.watchdog = duration_125us;
  return enter("dhdSetWatchdog");
}

int dhdSetEffectorMass(double kg, char) {
  const Locked locked;
  if (!(kg > 0.0)) return last_error = kErrorCode, -1;
  return enter("dhdSetEffectorMass");
}

int dhdGetGripperAngleRad(double* rad, char) {
  const Locked locked;
  *rad = state.handle.grips() ? 0.0 : state.gripper_rad;
  return enter("dhdGetGripperAngleRad");
}

int dhdGetGripperGap(double* gap_m, char) {
  const Locked locked;
  constexpr double kFinger_m = 0.05;
  *gap_m = kFinger_m * std::abs(state.handle.grips() ? 0.0 : state.gripper_rad);
  return enter("dhdGetGripperGap");
}

unsigned dhdGetButtonMask(char) {
  const Locked locked;
  return state.handle.grips() ? 1 : state.buttons;
}

int dhdErrorGetLast() { return last_error; }
// NOLINTEND(readability-identifier-naming)
}
