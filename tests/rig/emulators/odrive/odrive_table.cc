// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/odrive/odrive_table.h"

#include <algorithm>

namespace tact::rig {
namespace {

using enum WireType;
using enum OdriveFrom;
using G = OdriveGeneration;

constexpr OdriveMessage kMessages[] = {
    {0x00,
     "get_version",
     kDrive,
     G::k06,
     8,
     {{{"protocol", 0, kU8},
       {"hw_major", 1, kU8},
       {"hw_minor", 2, kU8},
       {"hw_variant", 3, kU8},
       {"fw_major", 4, kU8},
       {"fw_minor", 5, kU8}}}},
    {0x01,
     "heartbeat",
     kDrive,
     G::k06,
     8,
     {{{"axis_error", 0, kU32},
       {"axis_state", 4, kU8},
       {"procedure_result", 5, kU8},
       {"trajectory_done", 48, kBit}}}},
    {0x01,
     "heartbeat_v0_5",
     kDrive,
     G::k05,
     8,
     {{{"axis_error", 0, kU32},
       {"axis_state", 4, kU8},
       {"motor_error_flag", 40, kBit},
       {"encoder_error_flag", 48, kBit},
       {"controller_error_flag", 56, kBit},
       {"trajectory_done", 63, kBit}}}},
    {0x02, "estop", kHost, G::kBoth, 0},
    {0x03,
     "get_error",
     kDrive,
     G::k06,
     8,
     {{{"active_errors", 0, kU32}, {"disarm_reason", 4, kU32}}}},
    {0x03, "get_motor_error", kDrive, G::k05, 8, {{{"motor_error", 0, kU64}}}},
    {0x04, "get_encoder_error", kDrive, G::k05, 8, {{{"encoder_error", 0, kU32}}}},
    {0x05, "get_sensorless_error", kDrive, G::k05, 8, {{{"sensorless_error", 0, kU32}}}},
    {0x07, "set_axis_state", kHost, G::kBoth, 8, {{{"state", 0, kU32}}}},
    {0x09,
     "get_encoder_estimates",
     kDrive,
     G::kBoth,
     8,
     {{{"pos_turns", 0, kF32}, {"vel_turns_s", 4, kF32}}}},
    {0x0A, "get_encoder_count", kDrive, G::k05, 8, {{{"shadow", 0, kI32}, {"in_turn", 4, kI32}}}},
    {0x0B,
     "set_controller_mode",
     kHost,
     G::kBoth,
     8,
     {{{"control_mode", 0, kU32}, {"input_mode", 4, kU32}}}},
    {0x0C,
     "set_input_pos",
     kHost,
     G::kBoth,
     8,
     {{{"pos", 0, kF32}, {"vel_ff", 4, kI16, 0.001}, {"torque_ff", 6, kI16, 0.001}}}},
    {0x0D, "set_input_vel", kHost, G::kBoth, 8, {{{"vel", 0, kF32}, {"torque_ff", 4, kF32}}}},
    {0x0E, "set_input_torque", kHost, G::kBoth, 4, {{{"torque", 0, kF32}}}},
    {0x0F, "set_limits", kHost, G::kBoth, 8, {{{"velocity", 0, kF32}, {"current", 4, kF32}}}},
    {0x14, "get_iq", kDrive, G::kBoth, 8, {{{"iq_setpoint", 0, kF32}, {"iq_measured", 4, kF32}}}},
    {0x15, "get_temperature", kDrive, G::k06, 8, {{{"fet", 0, kF32}, {"motor", 4, kF32}}}},
    {0x16, "reboot", kHost, G::kBoth, 0},
    {0x17, "get_bus_voltage_current", kDrive, G::kBoth, 8, {{{"volt", 0, kF32}, {"amp", 4, kF32}}}},
    {0x18, "clear_errors", kHost, G::kBoth, 0, {{{"identify", 0, kU8}}}},
    {0x1C, "get_torques", kDrive, G::k06, 8, {{{"target", 0, kF32}, {"estimate", 4, kF32}}}},
    {0x1D, "get_powers", kDrive, G::k06, 8, {{{"electrical", 0, kF32}, {"mechanical", 4, kF32}}}},
    {0x1D, "get_controller_error", kDrive, G::k05, 8, {{{"controller_error", 0, kU32}}}},
};

}  // namespace

std::span<const WireField> OdriveMessage::used() const {
  const auto end = std::find_if(fields.begin(), fields.end(),
                                [](const WireField& field) { return field.name.empty(); });
  return {fields.begin(), end};
}

std::span<const OdriveMessage> odrive_messages() { return kMessages; }

const OdriveMessage* odrive_message(std::string_view name, OdriveFrom from) {
  for (const OdriveMessage& message : kMessages)
    if (message.name == name && message.from == from) return &message;
  return nullptr;
}

const OdriveMessage* odrive_reply(std::uint8_t command, OdriveGeneration generation) {
  for (const OdriveMessage& message : kMessages)
    if (message.command == command && message.from == kDrive &&
        (static_cast<unsigned>(message.generation) & static_cast<unsigned>(generation)) != 0)
      return &message;
  return nullptr;
}

}  // namespace tact::rig
