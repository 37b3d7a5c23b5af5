// SPDX-License-Identifier: Apache-2.0
// stub_dhd.h - how a test steers the stand-in for Force Dimension's library (stub_dhd.cc).
//
// Found by dlsym as the library's own functions are; all may be called from any thread.
#pragma once

extern "C" {

/// As after loading: one device of the type in TACT_STUB_DHD_TYPE (63, delta.3), calibrated.
void stub_dhd_reset();
void stub_dhd_set_type(int type);
void stub_dhd_set_count(int devices);
/// Overrides one word of the status from now on.
void stub_dhd_set_status(int word, int value);
/// The named function fails with this code until the next reset; 0: works again.
void stub_dhd_fail(const char* function, int error);
/// What dhdGetPositionAndOrientationFrame answers when it succeeds: 0, or 1 (nothing new).
void stub_dhd_set_pose_answer(int answer);
/// Holds the handle here instead of leaving it to the hand; NaN is passed on.
void stub_dhd_hold(double x_m, double y_m, double z_m);
/// Turns the wrist at this rate about z.
void stub_dhd_spin(double radps);
/// Turns the wrist so from now on, by the rotation matrix, row by row.
void stub_dhd_turn(const double r[3][3]);
/// The gripper's angle and the mask of the buttons.
void stub_dhd_grip(double gripper_rad, unsigned buttons);
/// dhdGetPositionAndOrientationFrame takes so long.
void stub_dhd_set_delay_us(int us);
/// The watchdog never fires: a PC that builds and tests stalls longer than it allows.
void stub_dhd_ignore_watchdog(int ignore);
/// Calls of the named function since the reset.
long stub_dhd_calls(const char* function);
/// fx fy fz tx ty tz of the last force call; its last argument says whether the motors are on.
int stub_dhd_last_force(double force[6]);
/// The same of the gripper.
double stub_dhd_last_grip_N();
/// Last value given to dhdSetWatchdog, dhdSetTimeGuard, dhdSetGravityCompensation.
void stub_dhd_settings(int* watchdog, int* time_guard, int* gravity);
/// Largest force that reached the motors in newtons since the reset.
double stub_dhd_strongest_N();
/// How often the forces were switched while the last one was not zero.
long stub_dhd_switched_with_force();
int stub_dhd_is_open();
}
