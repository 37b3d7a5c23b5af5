// SPDX-License-Identifier: Apache-2.0
#include "hal/odrive/odrive_errors.h"

#include <fmt/core.h>

namespace tact::hal::odrive {
namespace {

constexpr OdriveErrorText kUnknown{
    0, "UNKNOWN", "The drive reports an error bit that is not known here: ask odrivetool."};

constexpr OdriveErrorText kWords[] = {
    {0x1, "INITIALIZING", "The drive is still starting: wait a second and try again."},
    {0x2, "SYSTEM_LEVEL",
     "The drive's firmware met an internal error: restart it, and update the firmware if it comes "
     "back."},
    {0x4, "TIMING_ERROR",
     "The drive missed its own control deadline: restart it, and turn off what it does besides."},
    {0x8, "MISSING_ESTIMATE",
     "The drive does not know where its motor is: is the encoder connected and calibrated?"},
    {0x10, "BAD_CONFIG", "A setting of the drive is wrong or missing: check it with odrivetool."},
    {0x20, "DRV_FAULT",
     "The power stage reports a fault: check the motor cables for a short, then restart the "
     "drive."},
    {0x40, "MISSING_INPUT", "The drive gets no input: set the input mode to pass-through."},
    {0x100, "DC_BUS_OVER_VOLTAGE",
     "DC bus voltage too high: braking fed energy back; fit a brake resistor or brake more "
     "gently."},
    {0x200, "DC_BUS_UNDER_VOLTAGE", "DC bus voltage too low: is the drive's supply on?"},
    {0x400, "DC_BUS_OVER_CURRENT",
     "The drive drew too much current from its supply: lower the limits or take a stronger "
     "supply."},
    {0x800, "DC_BUS_OVER_REGEN_CURRENT",
     "Braking fed too much current back into the supply: fit or enable a brake resistor."},
    {0x1000, "CURRENT_LIMIT_VIOLATION",
     "The motor current went over its limit: check the current limit and the motor calibration."},
    {0x2000, "MOTOR_OVER_TEMP", "The motor is too hot: let it cool, then ask for less force."},
    {0x4000, "INVERTER_OVER_TEMP",
     "The drive's power stage is too hot: let it cool and check its cooling."},
    {0x8000, "VELOCITY_LIMIT_VIOLATION",
     "The motor turned faster than the drive allows: move more slowly or raise the drive's "
     "velocity limit."},
    {0x10000, "POSITION_LIMIT_VIOLATION",
     "The joint left its permitted range: bring the arm back by hand."},
    {0x1000000, "WATCHDOG_TIMER_EXPIRED",
     "No command reached the drive in time: check the CAN cable, and that the controller runs."},
    {0x2000000, "ESTOP_REQUESTED",
     "An emergency stop was requested: remove its cause, then start again."},
    {0x4000000, "SPINOUT_DETECTED",
     "Power and motion do not fit, the encoder may have slipped: check its fixing and calibrate "
     "again."},
    {0x8000000, "BRAKE_RESISTOR_DISARMED",
     "The brake resistor is configured but not active: check its wiring, then restart the drive."},
    {0x10000000, "THERMISTOR_DISCONNECTED",
     "The motor's temperature sensor is missing: connect it, or turn it off in the drive."},
    {0x40000000, "CALIBRATION_ERROR",
     "Calibration failed: let the motor turn freely, check its cables and calibrate again."},
};

constexpr OdriveErrorText kWords05[] = {
    {0x1, "INVALID_STATE",
     "The drive cannot enter the state that was asked for: calibrate motor and encoder first."},
    {0x2, "DC_BUS_UNDER_VOLTAGE", "DC bus voltage too low: is the drive's supply on?"},
    {0x4, "DC_BUS_OVER_VOLTAGE",
     "DC bus voltage too high: braking fed energy back; fit a brake resistor or brake more "
     "gently."},
    {0x8, "CURRENT_MEASUREMENT_TIMEOUT",
     "The drive missed a current measurement: restart it, and update the firmware if it comes "
     "back."},
    {0x10, "BRAKE_RESISTOR_DISARMED",
     "The brake resistor is configured but not active: check its wiring, then restart the drive."},
    {0x20, "MOTOR_DISARMED",
     "The motor was switched off unexpectedly: read the motor's own error with odrivetool."},
    {0x40, "MOTOR_FAILED",
     "The motor or its power stage failed: check the motor cables and read the motor's own error "
     "with odrivetool."},
    {0x80, "SENSORLESS_ESTIMATOR_FAILED",
     "The drive runs without an encoder and lost the motor: set it up with an encoder."},
    {0x100, "ENCODER_FAILED",
     "The encoder failed: check its cable, power and magnet, then calibrate again."},
    {0x200, "CONTROLLER_FAILED",
     "The drive's controller stopped, most often by overspeed: move more slowly or raise its "
     "velocity limit."},
    {0x400, "POS_CTRL_DURING_SENSORLESS",
     "Position control needs an encoder: set the drive up with one."},
    {0x800, "WATCHDOG_TIMER_EXPIRED",
     "No command reached the drive in time: check the CAN cable, and that the controller runs."},
    {0x1000, "MIN_ENDSTOP_PRESSED",
     "The lower end switch is pressed: move the arm off it by hand."},
    {0x2000, "MAX_ENDSTOP_PRESSED",
     "The upper end switch is pressed: move the arm off it by hand."},
    {0x4000, "ESTOP_REQUESTED",
     "An emergency stop was requested: remove its cause, then start again."},
    {0x20000, "HOMING_WITHOUT_ENDSTOP",
     "Homing needs the lower end switch, which is turned off: enable it in the drive."},
    {0x40000, "OVER_TEMP",
     "Motor or power stage are too hot: let them cool, then ask for less force."},
    {0x80000, "UNKNOWN_POSITION",
     "The drive does not know where its motor is: calibrate the encoder or find its index."},
};

const OdriveErrorText* first_of(std::uint32_t axis_error,
                                std::span<const OdriveErrorText> words) RT_SAFE {
  if (axis_error == 0) return nullptr;
  const std::uint32_t lowest = axis_error & (~axis_error + 1u);
  for (const OdriveErrorText& one : words)  // bound: words of the table
    if (one.bit == lowest) return &one;
  return &kUnknown;
}

}  // namespace

std::span<const OdriveErrorText> odrive_error_texts() RT_SAFE { return kWords; }
std::span<const OdriveErrorText> odrive_error_texts_05() RT_SAFE { return kWords05; }

const OdriveErrorText* first_odrive_error(std::uint32_t axis_error) RT_SAFE {
  return first_of(axis_error, kWords);
}
const OdriveErrorText* first_odrive_error_05(std::uint32_t axis_error) RT_SAFE {
  return first_of(axis_error, kWords05);
}

std::uint32_t odrive_parts_05(const OdriveHeartbeat05& heartbeat) RT_SAFE {
  return (heartbeat.motor_error ? 1u : 0u) | (heartbeat.encoder_error ? 2u : 0u) |
         (heartbeat.controller_error ? 4u : 0u);
}

std::string odrive_error_message(OdriveGeneration generation, std::uint32_t axis_error,
                                 std::uint32_t parts) {
  const OdriveErrorText* words = generation == OdriveGeneration::k06
                                     ? first_odrive_error(axis_error)
                                     : first_odrive_error_05(axis_error);
  if (words != nullptr)
    return fmt::format("{} ({}, 0x{:X})", words->message, words->name, axis_error);
  if ((parts & 1u) != 0) return "the motor reports an error: read axis.motor.error in odrivetool";
  if ((parts & 2u) != 0)
    return "the encoder reports an error: read axis.encoder.error in odrivetool";
  if ((parts & 4u) != 0)
    return "the controller reports an error: read axis.controller.error in odrivetool";
  return {};
}

}  // namespace tact::hal::odrive
