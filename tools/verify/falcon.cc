// SPDX-License-Identifier: Apache-2.0
// The published bytes of the Falcon: commands and reports both ways, damaged streams, and what the
// USB adapter adds.
#include <string>
#include <vector>

#include "hal/falcon/falcon_boot.h"
#include "hal/falcon/falcon_packets.h"
#include "hal/falcon/ftdi_requests.h"
#include "tools/verify/can.h"
#include "tools/verify/falcon_boot.h"
#include "tools/verify/report.h"

namespace tact::tools::verify {
namespace falcon_cases {

using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

void equal(Report& report, const std::string& field, const json& got, const json& want) {
  report.compare(field, got, want, false, 0.0, 0.0);
}

void verify_commands(const json& commands, Report& report) {
  int number = 0;
  for (const json& one : commands) {
    report.begin_case("commands/" + std::to_string(number++));
    const hal::falcon::FalconCommand wanted{
        .motor = one.at("motors_requested").get<hal::falcon::FalconWords>(),
        .lights = one.at("leds").get<std::uint8_t>(),
        .homing = one.at("homing").get<bool>()};
    // Both ways: an error that encoding and decoding share would hide itself in one round trip.
    equal(report, "hex", to_hex(encode(wanted)), one.at("hex"));
    const auto sent = hal::falcon::decode_falcon_command(from_hex(one.at("hex"), report));
    equal(report, "decoded", sent.has_value(), true);
    if (!sent) continue;
    equal(report, "motors_sent", sent->motor, one.at("motors_sent"));
    equal(report, "leds", sent->lights, one.at("leds"));
    equal(report, "homing", sent->homing, one.at("homing"));
  }
}

json to_json(const hal::falcon::FalconReport& r) {
  return {{"encoders", r.counts}, {"buttons", r.buttons}, {"homed", r.homed}};
}

void verify_reports(const json& reports, Report& report) {
  int number = 0;
  for (const json& one : reports) {
    report.begin_case("reports/" + std::to_string(number++));
    const hal::falcon::FalconReport wanted{
        .counts = one.at("encoders").get<hal::falcon::FalconWords>(),
        .buttons = one.at("buttons").get<std::uint8_t>(),
        .homed = one.at("homed").get<std::uint8_t>()};
    equal(report, "hex", to_hex(encode(wanted)), one.at("hex"));
    const auto got = hal::falcon::decode_falcon_report(from_hex(one.at("hex"), report));
    equal(report, "decoded", got.has_value(), true);
    if (got) equal(report, "report", to_json(*got), to_json(wanted));
  }
}

void verify_streams(const json& streams, Report& report) {
  int number = 0;
  for (const json& one : streams) {
    report.begin_case("streams/" + std::to_string(number++));
    hal::falcon::FalconStream stream;
    json got = json::array();
    for (const json& chunk : one.at("chunks")) {
      for (const std::uint8_t byte : from_hex(chunk, report))
        if (const auto whole = stream.push(byte)) got.push_back(to_json(*whole));
    }
    equal(report, "reports", got, one.at("reports"));
    equal(report, "dropped_bytes", stream.dropped_bytes(), one.at("dropped_bytes"));
    equal(report, "left_in_buffer", stream.waiting_bytes(), one.at("left_in_buffer"));
  }
}

void verify_strip(const json& transfers, Report& report) {
  int number = 0;
  for (const json& one : transfers) {
    report.begin_case("strip/" + std::to_string(number++));
    const Bytes transfer = from_hex(one.at("transfer"), report);
    Bytes data(transfer.size());
    const auto got = hal::falcon::ftdi_strip(transfer, data);
    equal(report, "whole", got.has_value(), true);
    equal(report, "packet_size", hal::falcon::kFtdiPacketSize, one.at("packet_size"));
    if (!got) continue;
    equal(report, "data", to_hex(std::span(data).first(got->size)), one.at("data"));
    equal(report, "modem_status", got->modem, one.at("modem_status"));
    equal(report, "line_status", got->line, one.at("line_status"));
    equal(report, "cts", got->clear_to_send(), one.at("cts"));
  }
}

void verify_baud(const json& codes, Report& report) {
  int number = 0;
  for (const json& one : codes) {
    report.begin_case("ftdi/baud/" + std::to_string(number++));
    const auto got = hal::falcon::ftdi_baud_Hz(one.at("wValue").get<std::uint16_t>());
    // A quotient: only its last bits may differ.
    report.compare("baud", got.value_or(0.0), one.at("baud"), true, 0.0, 1e-15);
  }
}

void verify_falcon(const json& file, Report& report) {
  report.begin_case("usb");
  equal(report, "usb",
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
