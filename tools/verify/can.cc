// SPDX-License-Identifier: Apache-2.0
// The published CAN frames: SocketCAN's error frames and bits on the bus, ODrive's messages; the
// frames of CiA 402 are in can_cia402.cc, those of moteus in can_moteus.cc.
#include "tools/verify/can.h"

#include <fmt/core.h>

#include "hal/can/can_error.h"
#include "hal/odrive/odrive_protocol.h"

namespace tact::tools::verify {

using hal::can::CanFrame;
using nlohmann::json;

std::string to_hex(std::span<const std::uint8_t> bytes) {
  std::string digits;
  for (const std::uint8_t byte : bytes) digits += fmt::format("{:02x}", byte);
  return digits;
}

std::vector<std::uint8_t> from_hex(const std::string& digits, Report& report) {
  if (digits.size() % 2 != 0 || digits.find_first_not_of("0123456789abcdef") != std::string::npos) {
    report.call_damaged(fmt::format("\"{}\" is no row of bytes", digits));
    return {};
  }
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(digits.substr(i, 2), nullptr, 16)));
  return bytes;
}

CanFrame frame_of(std::uint32_t id, const std::string& digits, Report& report) {
  const std::vector<std::uint8_t> bytes = from_hex(digits, report);
  if (id > hal::can::kCanLargestId || bytes.size() > 8) {
    report.call_damaged(fmt::format("{} with \"{}\" is no CAN frame", id, digits));
    return {};
  }
  CanFrame frame = hal::can::make_can_frame(id, static_cast<std::uint8_t>(bytes.size()));
  std::copy(bytes.begin(), bytes.end(), frame.data.begin());
  return frame;
}

void compare_equal(Report& report, const json& got, const json& want) {
  json all = got;
  all.update(want);
  for (const auto& [field, ignored] : all.items())
    report.equal(field, got.value(field, json()), want.value(field, json()));
}

void compare_encoded(Report& report, const std::optional<CanFrame>& frame, const json& want) {
  const auto bytes = frame ? hal::can::pack_can_frame(*frame) : std::nullopt;
  report.equal("encodes", bytes.has_value(), true);
  if (!bytes) return;
  report.equal("id", frame->id, want.at("id"));
  report.equal("rtr", frame->rtr, want.value("rtr", false));
  report.equal("data", to_hex(frame->payload()), want.at("data"));
  if (want.contains("dlc")) report.equal("dlc", frame->length, want["dlc"]);
  report.equal("can_frame", to_hex(*bytes), want.at("can_frame"));
  const auto back = hal::can::unpack_can_frame(from_hex(want.at("can_frame"), report));
  report.equal("reads back", back == frame, true);
}

namespace can_cases {

bool refuses_damaged_error(const std::vector<std::uint8_t>& bytes) {
  auto data_frame = bytes, classless = bytes, short_data = bytes, cut = bytes;
  data_frame[3] = 0;
  classless[0] = classless[1] = 0;
  short_data[4] = 7;
  cut.pop_back();
  return !hal::can::decode_can_error(data_frame) && !hal::can::decode_can_error(classless) &&
         !hal::can::decode_can_error(short_data) && !hal::can::decode_can_error(cut) &&
         !hal::can::unpack_can_frame(bytes);
}

void verify_socketcan(const json& file, Report& report) {
  report.each("error_frames", file.at("error_frames"), [&](const json& one) {
    const auto bytes = from_hex(one.at("can_frame"), report);
    const auto error = hal::can::decode_can_error(bytes);
    report.equal("reads", error.has_value(), true);
    if (!error) return;
    report.equal("bus_gone", error->is_bus_gone(), one.at("bus_gone"));
    report.equal("refuses damage", refuses_damaged_error(bytes), true);
  });
  report.each("bus_bits", file.at("bus_bits"), [&](const json& one) {
    const CanFrame frame = frame_of(one.at("id"), one.at("data"), report);
    const int most = hal::can::most_can_bits(frame.length);
    report.equal("bits_max", most, one.at("bits_max"));
    report.equal("bits <= bits_max", one.at("bits") <= most, true);
  });
}

/// Messages that no ODrive here receives or sends, by the numbers of their commands.
const json& never_used() {
  static const json numbers{{"get_error", 0x03},
                            {"address", 0x06},
                            {"set_input_pos", 0x0C},
                            {"set_input_vel", 0x0D},
                            {"get_iq", 0x14},
                            {"get_temperature", 0x15},
                            {"reboot", 0x16},
                            {"get_bus_voltage_current", 0x17},
                            {"set_absolute_position", 0x19},
                            {"get_torques", 0x1C},
                            {"get_powers", 0x1D}};
  return numbers;
}

std::optional<CanFrame> odrive_encoded(const std::string& message, const json& args,
                                       Report& report) {
  const int node = args.at("node");
  const auto value = [&args](const char* name) { return number(args.at(name)); };
  using hal::odrive::OdriveTorqueLength;
  if (message == "set_input_torque")
    return hal::odrive::odrive_input_torque(node, value("torque"), OdriveTorqueLength::kPadded);
  if (message == "set_input_torque_dlc4")
    return hal::odrive::odrive_input_torque(node, value("torque"), OdriveTorqueLength::kShort);
  if (message == "set_axis_state")
    return hal::odrive::odrive_axis_state(node, hal::odrive::OdriveAxisState{args.at("state")});
  if (message == "set_controller_mode") {
    return hal::odrive::odrive_controller_mode(
        node, hal::odrive::OdriveControlMode{args.at("control_mode")},
        hal::odrive::OdriveInputMode{args.at("input_mode")});
  }
  if (message == "set_limits")
    return hal::odrive::odrive_limits(node, value("velocity"), value("current"));
  if (message == "estop") return hal::odrive::odrive_estop(node);
  if (message == "clear_errors")
    return hal::odrive::odrive_clear_errors(node, args.at("identify") != 0);
  if (message == "rtr_get_encoder_estimates")
    return hal::odrive::odrive_request(node, hal::odrive::OdriveCommand::kGetEncoderEstimates);
  report.call_damaged(fmt::format("no message \"{}\"", message));
  return std::nullopt;
}

json odrive_decoded(const CanFrame& frame, const std::string& name, Report& report) {
  const hal::odrive::OdriveAddress address = hal::odrive::odrive_address(frame);
  json got;
  if (name == "heartbeat") {
    const auto fields = [](const hal::odrive::OdriveHeartbeat& h) -> json {
      return {{"axis_error", h.axis_error},
              {"axis_state", h.axis_state},
              {"procedure_result", h.procedure_result},
              {"trajectory_done", h.trajectory_done}};
    };
    got = decoded(frame, address.node, hal::odrive::decode_odrive_heartbeat, fields, report);
  } else if (name == "get_encoder_estimates") {
    const auto fields = [](const hal::odrive::OdriveEstimates& e) -> json {
      return {{"pos_turns", e.position_turns}, {"vel_turns_s", e.velocity_turns_per_s}};
    };
    got = decoded(frame, address.node, hal::odrive::decode_odrive_estimates, fields, report);
  } else {
    report.call_damaged(fmt::format("no reply \"{}\"", name));
  }
  got.update({{"node", address.node}, {"cmd", address.command}, {"name", name}});
  return got;
}

json heartbeat_05(const hal::odrive::OdriveHeartbeat05& h) {
  return {{"axis_error", h.axis_error},
          {"axis_state", h.axis_state},
          {"motor_error_flag", h.motor_error},
          {"encoder_error_flag", h.encoder_error},
          {"controller_error_flag", h.controller_error},
          {"trajectory_done", h.trajectory_done}};
}

/// Every published command and no other, by number.
json odrive_commands() {
  using Command = hal::odrive::OdriveCommand;
  json numbers{{"get_version", Command::kGetVersion},
               {"heartbeat", Command::kHeartbeat},
               {"estop", Command::kEstop},
               {"set_axis_state", Command::kSetAxisState},
               {"get_encoder_estimates", Command::kGetEncoderEstimates},
               {"get_encoder_count_v05", Command::kGetEncoderCount05},
               {"set_controller_mode", Command::kSetControllerMode},
               {"set_input_torque", Command::kSetInputTorque},
               {"set_limits", Command::kSetLimits},
               {"clear_errors", Command::kClearErrors}};
  numbers.update(never_used());
  return numbers;
}

void verify_odrive(const json& file, Report& report) {
  report.begin_case("commands");
  compare_equal(report, odrive_commands(), file.at("commands"));
  int number = 0;
  for (const json& one : file.at("encode")) {
    if (never_used().contains(one.at("message"))) continue;
    report.begin_case("encode/" + std::to_string(number++));
    compare_encoded(report, odrive_encoded(one.at("message"), one.at("args"), report), one);
  }
  number = 0;
  for (const json& one : file.at("decode")) {
    const json& expect = one.at("expect");
    if (never_used().contains(expect.at("name"))) continue;
    report.begin_case("decode/" + std::to_string(number++));
    const CanFrame frame = frame_of(one.at("id"), one.at("data"), report);
    compare_equal(report, odrive_decoded(frame, expect.at("name"), report), expect);
  }
  report.each("heartbeat_v0_5", file.at("heartbeat_v0_5"), [&](const json& one) {
    constexpr int kNode = 5;  // the file leaves it open
    const CanFrame frame = frame_of(kNode << 5 | 1, one.at("data"), report);
    compare_equal(
        report,
        decoded(frame, kNode, hal::odrive::decode_odrive_heartbeat_05, heartbeat_05, report),
        one.at("expect"));
  });
}

constexpr Verifier kVerifiers[] = {
    {"can_socketcan/1", verify_socketcan},
    {"can_odrive/1", verify_odrive},
    {"can_cia402/1", verify_cia402},
    {"can_moteus/1", verify_moteus},
};

}  // namespace can_cases

std::span<const Verifier> can_verifiers() { return can_cases::kVerifiers; }

}  // namespace tact::tools::verify
