// SPDX-License-Identifier: Apache-2.0
// What a moteus reports, in words: faults with the remedy, modes.
#include <fmt/core.h>

#include <algorithm>

#include "hal/moteus/moteus_protocol.h"

namespace tact::hal::moteus {
namespace {

constexpr MoteusFaultText kWords[] = {
    {32,
     "Calibration failed, it senses no magnet: check the magnet's distance, then moteus_tool "
     "--calibrate."},
    {33,
     "The power stage reports a fault, most often a supply that drops under load: take a "
     "stronger supply, check the motor cables for a short."},
    {34,
     "DC bus voltage too high: braking fed energy back; take a supply or a damper that sinks "
     "it."},
    {35, "The encoder's readings fit no magnet: check magnet and encoder, then calibrate again."},
    {36, "The motor is not configured: moteus_tool --calibrate."},
    {37,
     "The firmware missed a cycle of its own: restart the drive, update it if that comes back."},
    {38, "The drive or the motor is too hot: let it cool, then ask for less force."},
    {39,
     "The position is outside servopos.position_min and position_max: bring the arm back by "
     "hand, or set both to nan."},
    {40, "DC bus voltage too low: is the drive's supply on?"},
    {41, "A setting was changed while it ran: save, restart the drive."},
    {42,
     "It has no commutation encoder that is valid: check motor_position.sources, then "
     "calibrate."},
    {43, "It has no position that is valid: check motor_position.output and its encoder."},
    {44, "The power stage cannot be enabled: check the supply, restart the drive."},
    {46, "The firmware missed its own time: restart the drive, update it if that comes back."},
    {47, "servo.bemf_feedforward is set without an acceleration limit: set it to 0."},
    {48, "servopos.position_min or position_max lie beyond its range: set both to nan."},
    {49, "servo.fault_position_error acts, but tact sends no position: set it to nan."},
    {50, "servo.fault_velocity_error acts, but tact sends no velocity: set it to nan."},
};

}  // namespace

std::span<const MoteusFaultText> moteus_fault_texts() RT_SAFE { return kWords; }

std::string moteus_fault_message(int code) {
  const auto* const found =
      std::ranges::find_if(kWords, [code](const auto& one) { return one.code == code; });
  return fmt::format("{} (fault {})",
                     found != std::end(kWords)
                         ? found->message
                         : "The drive reports a fault that is not known here: ask moteus_tool.",
                     code);
}

const char* moteus_mode_name(int mode) RT_SAFE {
  switch (static_cast<MoteusMode>(mode)) {
    case MoteusMode::kStopped:
      return "stopped";
    case MoteusMode::kFault:
      return "in fault";
    case MoteusMode::kEnabling:
    case MoteusMode::kCalibrating:
    case MoteusMode::kCalibrated:
      return "preparing";
    case MoteusMode::kPosition:
      return "in position mode";
    case MoteusMode::kTimeout:
      return "in timeout";
  }
  return "in another mode";
}

}  // namespace tact::hal::moteus
