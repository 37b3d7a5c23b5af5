// SPDX-License-Identifier: Apache-2.0
// The published bytes of the Falcon: commands and reports both ways, damaged streams, and what the
// USB adapter adds.
#include <vector>

#include "hal/falcon/falcon_boot.h"
#include "hal/falcon/falcon_packets.h"
#include "hal/falcon/ftdi_requests.h"
#include "tools/verify/can.h"

namespace tact::tools::verify {
namespace falcon_cases {

using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

void verify_commands(const json& commands, Report& report) {
  report.each("commands", commands, [&](const json& one) {
    const hal::falcon::FalconCommand wanted{
        .motor = one.at("motors_requested").get<hal::falcon::FalconWords>(),
        .lights = one.at("leds").get<std::uint8_t>(),
        .homing = one.at("homing").get<bool>()};
    // Both ways: an error that encoding and decoding share would hide itself in one round trip.
    report.equal("hex", to_hex(encode(wanted)), one.at("hex"));
    const auto sent = hal::falcon::decode_falcon_command(from_hex(one.at("hex"), report));
    report.equal("decoded", sent.has_value(), true);
    if (!sent) return;
    report.equal("motors_sent", sent->motor, one.at("motors_sent"));
    report.equal("leds", sent->lights, one.at("leds"));
    report.equal("homing", sent->homing, one.at("homing"));
  });
}

json to_json(const hal::falcon::FalconReport& r) {
  return {{"encoders", r.counts}, {"buttons", r.buttons}, {"homed", r.homed}};
}

void verify_reports(const json& reports, Report& report) {
  report.each("reports", reports, [&](const json& one) {
    const hal::falcon::FalconReport wanted{
        .counts = one.at("encoders").get<hal::falcon::FalconWords>(),
        .buttons = one.at("buttons").get<std::uint8_t>(),
        .homed = one.at("homed").get<std::uint8_t>()};
    report.equal("hex", to_hex(encode(wanted)), one.at("hex"));
    const auto got = hal::falcon::decode_falcon_report(from_hex(one.at("hex"), report));
    report.equal("decoded", got.has_value(), true);
    if (got) report.equal("report", to_json(*got), to_json(wanted));
  });
}

void verify_streams(const json& streams, Report& report) {
  report.each("streams", streams, [&](const json& one) {
    hal::falcon::FalconStream stream;
    json got = json::array();
    for (const json& chunk : one.at("chunks")) {
      for (const std::uint8_t byte : from_hex(chunk, report))
        if (const auto whole = stream.push(byte)) got.push_back(to_json(*whole));
    }
    report.equal("reports", got, one.at("reports"));
    report.equal("dropped_bytes", stream.dropped_bytes(), one.at("dropped_bytes"));
    report.equal("left_in_buffer", stream.waiting_bytes(), one.at("left_in_buffer"));
  });
}

void verify_strip(const json& transfers, Report& report) {
  report.each("strip", transfers, [&](const json& one) {
    const Bytes transfer = from_hex(one.at("transfer"), report);
    Bytes data(transfer.size());
    const auto got = hal::falcon::ftdi_strip(transfer, data);
    report.equal("whole", got.has_value(), true);
    report.equal("packet_size", hal::falcon::kFtdiPacketSize, one.at("packet_size"));
    if (!got) return;
    report.equal("data", to_hex(std::span(data).first(got->size)), one.at("data"));
    report.equal("modem_status", got->modem, one.at("modem_status"));
    report.equal("line_status", got->line, one.at("line_status"));
    report.equal("cts", got->clear_to_send(), one.at("cts"));
  });
}

void verify_baud(const json& codes, Report& report) {
  report.each("ftdi/baud", codes, [&](const json& one) {
    const auto got = hal::falcon::ftdi_baud_Hz(one.at("wValue").get<std::uint16_t>());
    // A quotient: only its last bits may differ.
    report.near_ratio("baud", got.value_or(0.0), one.at("baud"), 1e-15);
  });
}

void verify_falcon(const json& file, Report& report) {
  report.begin_case("usb");
  report.equal("usb",
               {{"vid", hal::falcon::kFalconUsbVendor},
                {"pid", hal::falcon::kFalconUsbProduct},
                {"ep_out", hal::falcon::kFalconEndpointOut},
                {"ep_in", hal::falcon::kFalconEndpointIn},
                {"interface", hal::falcon::kFalconUsbInterface},
                {"bytes_per_packet", hal::falcon::kFalconPacketSize}},
               file.at("usb"));
  verify_commands(file.at("commands"), report);
  verify_reports(file.at("reports"), report);
  verify_streams(file.at("streams"), report);
  verify_strip(file.at("strip"), report);
  verify_baud(file.at("ftdi").at("baud"), report);
  verify_falcon_boot(file.at("ftdi"), report);
}

constexpr Verifier kVerifiers[] = {{"falcon_packets/1", verify_falcon}};

}  // namespace falcon_cases

std::span<const Verifier> falcon_verifiers() { return falcon_cases::kVerifiers; }

}  // namespace tact::tools::verify
