// SPDX-License-Identifier: Apache-2.0
// The published CAN FD frames of moteus: torque and stop with the kernel's bytes, replies by
// register. A case that cannot be read is named as one that failed, and the next one is evaluated.
#include <fmt/core.h>

#include <cmath>
#include <exception>

#include "hal/moteus/moteus_protocol.h"
#include "tools/verify/can.h"

namespace tact::tools::verify {
namespace {

using hal::can::CanFdFrame;
using hal::moteus::MoteusRegister;
using nlohmann::json;

void call_unreadable(Report& report, const std::string& why) {
  report.equal("reads", why, "a whole case");
}

void check_encoded(const json& one, Report& report) {
  const std::string message = one.at("message");
  const json& args = one.at("args");
  std::optional<CanFdFrame> frame;
  if (message == "torque") {
    frame = hal::moteus::moteus_torque(args.at("servo"), number(args.at("torque")),
                                       number(args.at("watchdog_s")));
  } else if (message == "stop") {
    frame = hal::moteus::moteus_stop(args.at("servo"));
  } else {
    return call_unreadable(report, fmt::format("no message \"{}\"", message));
  }
  const auto bytes = frame ? hal::can::pack_can_frame(*frame) : std::nullopt;
  report.equal("encodes", bytes.has_value(), true);
  if (!bytes) return;
  const json got{{"message", message},
                 {"args", args},
                 {"id", frame->id},
                 {"ext", ((*bytes)[3] & 0x80) != 0},
                 {"data", to_hex(frame->payload())},
                 {"canfd_frame", to_hex(*bytes)}};
  compare_equal(report, got, one);
  report.equal("reads back", hal::can::unpack_can_fd_frame(*bytes) == frame, true);
}

std::string key_of(MoteusRegister number) {
  return fmt::format("{:03x}", static_cast<unsigned>(number));
}

/// As the file has it: voltage and temperature in the steps that came.
json registers_of(const hal::moteus::MoteusReply& reply) {
  json out = json::object();
  const auto put = [&out](MoteusRegister number, const auto& value) {
    if (value) out[key_of(number)] = *value;
  };
  put(MoteusRegister::kMode, reply.mode);
  put(MoteusRegister::kPosition, reply.position_turns);
  put(MoteusRegister::kVelocity, reply.velocity_turns_per_s);
  put(MoteusRegister::kTorque, reply.torque_Nm);
  put(MoteusRegister::kFault, reply.fault);
  if (reply.voltage_V) out[key_of(MoteusRegister::kVoltage)] = std::lround(*reply.voltage_V / 0.5);
  if (reply.temperature_C)
    out[key_of(MoteusRegister::kTemperature)] = std::lround(*reply.temperature_C);
  return out;
}

/// Whether a reply is turned down that is cut, another drive's, or for another host.
bool refuses_damage(const CanFdFrame& sound, int node) {
  CanFdFrame cut = sound, stranger = sound, foreign = sound;
  cut.length = 20;
  stranger.id ^= 0x100;
  foreign.id |= 1;
  return !hal::moteus::decode_moteus(cut, node) && !hal::moteus::decode_moteus(stranger, node) &&
         !hal::moteus::decode_moteus(foreign, node);
}

void check_decoded(const json& one, Report& report) {
  Report hex;
  const auto bytes = from_hex(one.at("data"), hex);
  if (!hex.damage().empty()) return call_unreadable(report, hex.damage());
  CanFdFrame frame{
      .id = one.at("id"), .length = static_cast<std::uint8_t>(bytes.size()), .data = {}};
  if (bytes.size() > frame.data.size()) return call_unreadable(report, "more than 64 bytes");
  std::copy(bytes.begin(), bytes.end(), frame.data.begin());
  const auto address = hal::moteus::moteus_address(frame);
  const auto reply = hal::moteus::decode_moteus(frame, address.source);
  report.equal("decodes", reply.has_value(), true);
  if (!reply) return;
  const json got{{"source", address.source},
                 {"destination", address.destination},
                 {"registers", registers_of(*reply)}};
  compare_equal(report, got, one.at("expect"));
  report.equal("refuses damage", refuses_damage(frame, address.source), true);
}

template <class Check>
void check_each(const json& file, const char* section, Check check, Report& report) {
  report.each(section, file.at(section), [&](const json& one) {
    try {  // nlohmann/json reports a field that is missing, or is no number, by exceptions
      check(one, report);
    } catch (const std::exception& damage) {
      call_unreadable(report, damage.what());
    }
  });
}

}  // namespace

void verify_moteus(const json& file, Report& report) {
  report.begin_case("bitrate");
  report.equal("bitrate", {hal::can::kCanFdSlow_bps, hal::can::kCanFdFast_bps}, file.at("bitrate"));
  check_each(file, "encode", check_encoded, report);
  check_each(file, "decode", check_decoded, report);
}

}  // namespace tact::tools::verify
