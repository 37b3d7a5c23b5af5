// SPDX-License-Identifier: Apache-2.0
// The test's side of the stand-in.
#include <algorithm>

#include "tests/support/stub_dhd/stub_dhd.h"
#include "tests/support/stub_dhd/stub_dhd_state.h"

using namespace tact::tests::stub_dhd;

extern "C" {

void stub_dhd_reset() {
  const Locked locked;
  state = State();
}
void stub_dhd_set_type(int type) {
  const Locked locked;
  state.type = type;
}
void stub_dhd_set_count(int devices) {
  const Locked locked;
  state.count = devices;
}
void stub_dhd_set_status(int word, int value) {
  const Locked locked;
  state.fixed_status[word] = value;
}
void stub_dhd_fail(const char* function, int error) {
  const Locked locked;
  state.failing[function] = error;
}
void stub_dhd_set_pose_answer(int answer) {
  const Locked locked;
  state.pose_answer = answer;
}
void stub_dhd_hold(double x_m, double y_m, double z_m) {
  const Locked locked;
  state.handle.hold(x_m, y_m, z_m);
}
void stub_dhd_spin(double radps) {
  const Locked locked;
  state.spin_radps = radps;
}
void stub_dhd_turn(const double r[3][3]) {
  const Locked locked;
  std::copy(&r[0][0], &r[0][0] + 9, &state.turn[0][0]);
}
void stub_dhd_grip(double gripper_rad, unsigned buttons) {
  const Locked locked;
  state.gripper_rad = gripper_rad, state.buttons = buttons;
}
void stub_dhd_set_delay_us(int us) {
  const Locked locked;
  state.delay_us = us;
}
void stub_dhd_ignore_watchdog(int ignore) {
  const Locked locked;
  watchdog_sleeps = ignore != 0;
}
long stub_dhd_calls(const char* function) {
  const Locked locked;
  return state.calls[function];
}
int stub_dhd_last_force(double force[6]) {
  const Locked locked;
  std::copy(state.force, state.force + 6, force);
  return state.status[kForce];
}
void stub_dhd_settings(int* watchdog, int* time_guard, int* gravity) {
  const Locked locked;
  *watchdog = state.watchdog, *time_guard = state.time_guard, *gravity = state.gravity;
}
double stub_dhd_last_grip_N() {
  const Locked locked;
  return state.force[6];
}
long stub_dhd_switched_with_force() {
  const Locked locked;
  return state.switched_with_force;
}
double stub_dhd_strongest_N() {
  const Locked locked;
  return state.strongest_N;
}
int stub_dhd_is_open() {
  const Locked locked;
  return state.open ? 1 : 0;
}
}
