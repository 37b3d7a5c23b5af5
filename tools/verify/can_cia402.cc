// SPDX-License-Identifier: Apache-2.0
// The published frames of CANopen and CiA 402: what is sent, what comes back, states and torques.
#include <fmt/core.h>

#include <stdexcept>

#include "hal/cia402/canopen_frames.h"
#include "hal/cia402/cia402_cst.h"
#include "hal/cia402/cia402_state.h"
#include "tools/verify/can.h"

namespace tact::tools::verify {
namespace {

using hal::can::CanFrame;
using nlohmann::json;

void call_unknown(Report& report, const char* what, const std::string& word) {
  report.call_damaged(fmt::format("no {} \"{}\"", what, word));
}

hal::cia402::NmtCommand command_of(const std::string& word, Report& report) {
  if (word == "start") return hal::cia402::NmtCommand::kStart;
  if (word == "stop") return hal::cia402::NmtCommand::kStop;
  if (word == "preop") return hal::cia402::NmtCommand::kPreOperational;
  if (word == "reset_node") return hal::cia402::NmtCommand::kResetNode;
  if (word == "reset_comm") return hal::cia402::NmtCommand::kResetCommunication;
  call_unknown(report, "command", word);
  return {};
}

const char* word(hal::cia402::NmtState state) {
  switch (state) {
    case hal::cia402::NmtState::kBoot:
      return "boot";
    case hal::cia402::NmtState::kStopped:
      return "stopped";
    case hal::cia402::NmtState::kOperational:
      return "operational";
    case hal::cia402::NmtState::kPreOperational:
      break;
  }
  return "pre_operational";
}

std::optional<CanFrame> encoded(const std::string& message, const json& args, Report& report) {
  if (message == "sync") return hal::cia402::canopen_sync();
  const int node = args.at("node");
  if (message == "nmt")
    return hal::cia402::canopen_nmt(command_of(args.at("command"), report), node);
  if (message == "rpdo1_cst")
    return hal::cia402::cst_command(node, args.at("controlword"), args.at("torque_permille"));
  if (message == "sdo_download") {
    return hal::cia402::canopen_sdo_download(
        node, {args.at("index"), args.at("sub"), args.at("value"), args.at("size")});
  }
  if (message == "sdo_upload")
    return hal::cia402::canopen_sdo_upload(node, args.at("index"), args.at("sub"));
  call_unknown(report, "message", message);
  return std::nullopt;
}

json to_json(hal::cia402::NmtState state) { return {{"state", word(state)}}; }
json to_json(const hal::cia402::Emergency& e) {
  return {{"code", e.code},
          {"error_register", e.error_register},
          {"manufacturer", to_hex(e.manufacturer)}};
}
json to_json(const hal::cia402::CstSample& s) {
  const hal::cia402::Cia402Flags flags = hal::cia402::cia402_flags(s.statusword);
  return {{"statusword", s.statusword},
          {"state", hal::cia402::cia402_state_name(hal::cia402::cia402_state(s.statusword))},
          {"position", s.position_increments},
          {"torque_permille", s.torque_permille},
          {"following", flags.following},
          {"warning", flags.warning},
          {"internal_limit", flags.internal_limit}};
}
json to_json(const hal::cia402::SdoReply& r) {
  json got{{"index", r.index}, {"sub", r.sub}};
  switch (r.kind) {
    case hal::cia402::SdoReplyKind::kDownloadDone:
      got["kind"] = "download_ok";
      break;
    case hal::cia402::SdoReplyKind::kAbort:
      got.update({{"kind", "abort"}, {"code", r.value}});
      break;
    case hal::cia402::SdoReplyKind::kUpload:
      std::string raw;
      for (unsigned i = 0; i < r.size; ++i) raw += fmt::format("{:02x}", r.value >> (8 * i) & 0xFF);
      got.update({{"kind", "upload"}, {"size", r.size}, {"raw", raw}});
      break;
  }
  return got;
}

template <class Decode>
json decoded_of(const CanFrame& frame, int node, Decode decode, Report& report) {
  const auto read = [&](const CanFrame& f) { return decode(f, node); };
  report.compare("refuses damage", refuses_damage(frame, read), true, false, 0.0, 0.0);
  const auto value = read(frame);
  json got = value ? to_json(*value) : json::object();
  got["node"] = node;
  return got;
}

json decoded(const std::string& message, const CanFrame& frame, Report& report) {
  const int node = static_cast<int>(frame.id & 0x7Fu);
  if (message == "heartbeat")
    return decoded_of(frame, node, hal::cia402::decode_canopen_heartbeat, report);
  if (message == "emcy")
    return decoded_of(frame, node, hal::cia402::decode_canopen_emergency, report);
  if (message == "sdo_reply")
    return decoded_of(frame, node, hal::cia402::decode_canopen_sdo, report);
  if (message == "tpdo1_cst")
    return decoded_of(frame, node, hal::cia402::decode_cst_sample, report);
  call_unknown(report, "reply", message);
  return json::object();
}

void verify_configuration(const json& sequence, Report& report) {
  // The sequence of a drive that takes torque at the next SYNC.
  constexpr int kNode = 5;
  const auto writes = hal::cia402::cst_configuration(kNode, {.command_transmission_type = 1});
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    report.begin_case("config_sequence_node5/" + std::to_string(i));
    report.compare("writes", hal::cia402::kCstWrites, sequence.size(), false, 0.0, 0.0);
    if (!writes || i >= writes->size()) continue;
    const hal::cia402::SdoWrite& write = (*writes)[i];
    const auto frame = hal::cia402::canopen_sdo_download(kNode, write);
    compare_equal(report,
                  {{"index", write.index},
                   {"sub", write.sub},
                   {"value", write.value},
                   {"size", write.size},
                   {"frame", frame ? to_hex(frame->payload()) : "nothing"}},
                  sequence[i]);
  }
}

void verify_states(const json& states, Report& report) {
  int number = 0;
  for (const json& one : states) {
    report.begin_case("states/" + std::to_string(number++));
    const std::uint16_t statusword = one.at("statusword");
    const hal::cia402::Cia402State state = hal::cia402::cia402_state(statusword);
    const auto next = hal::cia402::next_controlword(state, hal::cia402::kControlDisableVoltage);
    compare_equal(report,
                  {{"statusword", statusword},
                   {"state", hal::cia402::cia402_state_name(state)},
                   {"next_controlword", next ? json(*next) : json()}},
                  one);
  }
}

void verify_torques(const json& torques, Report& report) {
  int number = 0;
  for (const json& one : torques) {
    report.begin_case("torque_conversion/" + std::to_string(number++));
    const double rated_torque_Nm = one.at("rated_mNm").get<double>() / 1000.0;
    const auto permille = hal::cia402::cst_torque_permille(one.at("tau_nm"), rated_torque_Nm);
    report.compare("permille", permille ? json(*permille) : json(), one.at("permille"), false, 0.0,
                   0.0);
  }
}

}  // namespace

void verify_cia402(const json& file, Report& report) {
  verify_configuration(file.at("config_sequence_node5"), report);
  int number = 0;
  for (const json& one : file.at("encode")) {
    report.begin_case("encode/" + std::to_string(number++));
    compare_encoded(report, encoded(one.at("message"), one.at("args"), report), one);
  }
  number = 0;
  for (const json& one : file.at("decode")) {
    report.begin_case("decode/" + std::to_string(number++));
    const CanFrame frame = frame_of(one.at("id"), one.at("data"), report);
    compare_equal(report, decoded(one.at("message"), frame, report), one.at("expect"));
  }
  verify_states(file.at("states"), report);
  verify_torques(file.at("torque_conversion"), report);
}

}  // namespace tact::tools::verify
