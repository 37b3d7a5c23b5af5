// SPDX-License-Identifier: Apache-2.0
// The published frames of CANopen and CiA 402: what is sent, what comes back, states and torques.
#include <fmt/core.h>

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

json state_field(hal::cia402::NmtState state) {
  using enum hal::cia402::NmtState;
  return {{"state", state == kBoot          ? "boot"
                    : state == kStopped     ? "stopped"
                    : state == kOperational ? "operational"
                                            : "pre_operational"}};
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

json emergency_fields(const hal::cia402::Emergency& e) {
  return {{"code", e.code},
          {"error_register", e.error_register},
          {"manufacturer", to_hex(e.manufacturer)}};
}
json sample_fields(const hal::cia402::CstSample& s) {
  const hal::cia402::Cia402Flags flags = hal::cia402::cia402_flags(s.statusword);
  return {{"statusword", s.statusword},
          {"state", hal::cia402::cia402_state_name(hal::cia402::cia402_state(s.statusword))},
          {"position", s.position_increments},
          {"torque_permille", s.torque_permille},
          {"following", flags.following},
          {"warning", flags.warning},
          {"internal_limit", flags.internal_limit}};
}
json reply_fields(const hal::cia402::SdoReply& r) {
  json got{{"index", r.index}, {"sub", r.sub}, {"kind", "download_ok"}};
  if (r.kind == hal::cia402::SdoReplyKind::kAbort)
    got.update({{"kind", "abort"}, {"code", r.value}});
  if (r.kind != hal::cia402::SdoReplyKind::kUpload) return got;
  std::string raw;
  for (unsigned i = 0; i < r.size; ++i) raw += fmt::format("{:02x}", r.value >> (8 * i) & 0xFF);
  got.update({{"kind", "upload"}, {"size", r.size}, {"raw", raw}});
  return got;
}

json reply_of(const std::string& message, const CanFrame& frame, Report& report) {
  const int node = static_cast<int>(frame.id & 0x7Fu);
  const auto read = [&](auto decode, auto fields) {
    json got = decoded(frame, node, decode, fields, report);
    got["node"] = node;
    return got;
  };
  if (message == "heartbeat") return read(hal::cia402::decode_canopen_heartbeat, state_field);
  if (message == "emcy") return read(hal::cia402::decode_canopen_emergency, emergency_fields);
  if (message == "sdo_reply") return read(hal::cia402::decode_canopen_sdo, reply_fields);
  if (message == "tpdo1_cst") return read(hal::cia402::decode_cst_sample, sample_fields);
  call_unknown(report, "reply", message);
  return json::object();
}

void verify_configuration(const json& sequence, Report& report) {
  // The sequence of a drive that takes torque at the next SYNC.
  constexpr int kNode = 5;
  const auto writes = hal::cia402::cst_configuration(kNode, {.command_transmission_type = 1});
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    report.begin_case("config_sequence_node5/" + std::to_string(i));
    report.equal("writes", hal::cia402::kCstWrites, sequence.size());
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

}  // namespace

void verify_cia402(const json& file, Report& report) {
  verify_configuration(file.at("config_sequence_node5"), report);
  report.each("encode", file.at("encode"), [&](const json& one) {
    compare_encoded(report, encoded(one.at("message"), one.at("args"), report), one);
  });
  report.each("decode", file.at("decode"), [&](const json& one) {
    const CanFrame frame = frame_of(one.at("id"), one.at("data"), report);
    compare_equal(report, reply_of(one.at("message"), frame, report), one.at("expect"));
  });
  report.each("states", file.at("states"), [&](const json& one) {
    const std::uint16_t statusword = one.at("statusword");
    const hal::cia402::Cia402State state = hal::cia402::cia402_state(statusword);
    const auto next = hal::cia402::next_controlword(state, hal::cia402::kControlDisableVoltage);
    compare_equal(report,
                  {{"statusword", statusword},
                   {"state", hal::cia402::cia402_state_name(state)},
                   {"next_controlword", next ? json(*next) : json()}},
                  one);
  });
  report.each("torque_conversion", file.at("torque_conversion"), [&](const json& one) {
    const double rated_torque_Nm = one.at("rated_mNm").get<double>() / 1000.0;
    const auto permille = hal::cia402::cst_torque_permille(one.at("tau_nm"), rated_torque_Nm);
    report.equal("permille", permille ? json(*permille) : json(), one.at("permille"));
  });
}

}  // namespace tact::tools::verify
