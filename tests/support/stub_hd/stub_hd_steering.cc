// SPDX-License-Identifier: Apache-2.0
// The test's side of the stand-in.
#include <algorithm>

#include "tests/support/stub_hd/stub_hd.h"
#include "tests/support/stub_hd/stub_hd_state.h"

using namespace tact::tests::stub_hd;

extern "C" {

void stub_hd_reset() {
  const Locked locked;
  state = State();
  silent = false;
}
void stub_hd_set_calibration(unsigned status) {
  const Locked locked;
  state.calibration = status;
}
void stub_hd_set_number(unsigned what, double value) {
  const Locked locked;
  state.numbers[what] = value;
}
void stub_hd_fail(const char* function, unsigned error) {
  const Locked locked;
  state.failing[function] = error;
}
void stub_hd_lose_force_output() {
  const Locked locked;
  state.output_lost = true;
  state.output = false;
}
void stub_hd_hold(double x_mm, double y_mm, double z_mm) {
  const Locked locked;
  state.handle.hold(1e-3 * (z_mm - kMiddle_mm[2]), 1e-3 * (x_mm - kMiddle_mm[0]),
                    1e-3 * (y_mm - kMiddle_mm[1]));
}
void stub_hd_lean(double rad) {
  const Locked locked;
  state.lean_rad = rad;
}
void stub_hd_turn(const double r[3][3]) {
  const Locked locked;
  // The stylus' x, y, z are the tool's y, -x, z; the device's are y, z, x of W.
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t w = (i + 1) % 3;
    state.turn[i] = r[w][1], state.turn[4 + i] = -r[w][0], state.turn[8 + i] = r[w][2];
  }
  state.turned = true;
}
void stub_hd_spin(double radps) {
  const Locked locked;
  state.spin_radps = radps;
}
void stub_hd_set_delay_us(int us) {
  const Locked locked;
  state.delay_us = us;
}
void stub_hd_open_anyway(int whether) {
  const Locked locked;
  state.opens_anyway = whether != 0;
}
void stub_hd_set_serial(const char* number) {
  const Locked locked;
  state.serial = number;
}
void stub_hd_silence(int whether) { silent = whether != 0; }
long stub_hd_calls(const char* function) {
  const Locked locked;
  return state.calls[function];
}
int stub_hd_last_force(double force_N[3]) {
  const Locked locked;
  std::copy(state.force_N.begin(), state.force_N.end(), force_N);
  return state.output ? 1 : 0;
}
double stub_hd_strongest_N() {
  const Locked locked;
  return state.strongest_N;
}
long stub_hd_unsafe_calls() {
  const Locked locked;
  return state.unsafe_calls;
}
int stub_hd_is_open() {
  const Locked locked;
  return state.open ? 1 : 0;
}
const char* stub_hd_name() {
  const Locked locked;
  return state.name.c_str();
}
}
