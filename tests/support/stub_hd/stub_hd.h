// SPDX-License-Identifier: Apache-2.0
// stub_hd.h - how a test steers the stand-in for the library of OpenHaptics (stub_hd.cc).
//
// Found by dlsym as the library's own functions are; all may be called from any thread.
#pragma once

extern "C" {

/// As after loading: a Touch with an inkwell, calibrated. The scheduler goes on.
void stub_hd_reset();
/// What hdCheckCalibration answers; an update makes 0x5001 ("needs one") 0x5000 ("is").
void stub_hd_set_calibration(unsigned status);
/// What a number of the device is, as hdGetDoublev or hdGetIntegerv returns it; of several, the
/// n-th from 1 is what + n * 0x10000.
void stub_hd_set_number(unsigned what, double value);
/// The named function leaves this error on the stack until the next reset; 0: works again.
void stub_hd_fail(const char* function, unsigned error);
/// Another program switches the force output off; until the next reset it stays off.
void stub_hd_lose_force_output();
/// Holds the stylus here, in mm of the device's frame, instead of leaving it to the hand.
void stub_hd_hold(double x_mm, double y_mm, double z_mm);
/// Leans the upright stylus so far towards the operator: pi/2 lays it down.
void stub_hd_lean(double rad);
/// The tool's rotation in W instead, row by row.
void stub_hd_turn(const double rotation[3][3]);
/// Turns the stylus at this rate about the device's y.
void stub_hd_spin(double radps);
/// hdBeginFrame takes so long.
void stub_hd_set_delay_us(int us);
/// hdInitDevice opens the device although it leaves an error.
void stub_hd_open_anyway(int whether);
void stub_hd_set_serial(const char* number);
/// The scheduler makes no calls.
void stub_hd_silence(int silent);
/// Calls of the named function since the reset.
long stub_hd_calls(const char* function);
/// The force that was sent last, in the device's frame; says whether the motors are on.
int stub_hd_last_force(double force_N[3]);
/// Largest force that reached the motors since the reset.
double stub_hd_strongest_N();
/// How often the force output was switched, on or off, while the last frame had carried a force, or
/// a frame carried one although its beginning, its state or its calibration were bad.
long stub_hd_unsafe_calls();
int stub_hd_is_open();
/// The name with which it was opened; "(default)" for none.
const char* stub_hd_name();
}
