// SPDX-License-Identifier: Apache-2.0
// self_check_falcon.cc - the vectors of the Falcon's packets and of its adapter, from the device's
// side.
#include "tests/rig/emulators/falcon/falcon_wire.h"
#include "tests/rig/emulators/falcon/ftdi_chip.h"
#include "tests/rig/emulators/self_check/self_check.h"

namespace tact::rig {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

FalconReport report_of(const Json& item) {
  const Json& counts = item["encoders"];
  return {{counts[0], counts[1], counts[2]}, item["buttons"], item["homed"]};
}
std::vector<FalconFrame> scan(FalconScanner& scanner, const Json& hex) {
  std::vector<FalconFrame> frames;
  for (const std::uint8_t byte : bytes_of_hex(hex))
    if (const auto frame = scanner.push(byte)) frames.push_back(*frame);
  return frames;
}

/// A transfer as the chip packs this data.
std::string transfer_of(const Json& item) {
  const Bytes data = bytes_of_hex(item["data"]);
  const FtdiStatus status{item["modem_status"], item["line_status"]};
  Bytes transfer;
  std::size_t at = 0;
  do {
    const std::size_t size = std::min(kFtdiData, data.size() - at);
    const Bytes packet = ftdi_packet(status, std::span(data).subspan(at, size));
    transfer.insert(transfer.end(), packet.begin(), packet.end());
    at += size;
  } while (at < data.size());
  return hex_of(transfer);
}

/// The whole way from reset to a report, by the requests and bytes of the vectors.
void check_boot(SelfCheck& check, const Json& ftdi) {
  constexpr int kImage = 200;
  FaultPlan faults;
  FalconFirmware firmware({.image_bytes = kImage}, faults);
  FtdiChip chip(firmware, true);
  std::int64_t now_ns = 1'000'000'000;
  const auto wait = [&](int ms) {  // and take what comes
    Bytes heard;
    for (int i = 0; i < 10 * ms; ++i) {
      now_ns += 100'000;
      chip.advance(now_ns);
      if (const auto packet = chip.packet(now_ns))
        heard.insert(heard.end(), packet->begin() + 2, packet->end());
    }
    return heard;
  };
  const auto ask = [&](const Json& step) {
    const FtdiSetup setup{step["bmRequestType"], step["bRequest"], step["wValue"], step["wIndex"],
                          step["wLength"]};
    check.same(step["name"], chip.control(setup, now_ns) ? "done" : "stalls", "done");
  };
  for (const Json& step : ftdi["open"]) ask(step);
  for (const Json& step : ftdi["bootloader"]) {
    if (step.contains("bRequest")) {
      ask(step);
    } else if (step.contains("bulk_out")) {
      wait(6);
      chip.write(bytes_of_hex(step["bulk_out"]), now_ns);
      Bytes heard = wait(40);
      if (heard.size() > 1 && heard[0] == 0) heard.erase(heard.begin());
      check.same("answer", hex_of(heard), step["expect_in"]);
    } else {
      Bytes image(kImage);
      for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<std::uint8_t>(37 * i);
      chip.write(image, now_ns);
      check.same("echo", hex_of(wait(40)), hex_of(image));
    }
  }
  for (const Json& step : ftdi["normal"]) ask(step);
  chip.write(bytes_of_hex("3c41414141414141414141414142413e"), now_ns);
  check.equal("bytes of the first report", static_cast<double>(wait(3).size()), 16.0, 0.0);
}

}  // namespace

int check_falcon(const std::string& folder) {
  return run_self_check(folder, [](SelfCheck& check) {
    check_falcon_packets(check);
    check_falcon_kinematics(check);
  });
}

void check_falcon_packets(SelfCheck& check) {
  const Json vectors = check.load("falcon_packets.json");
  check.begin("Falcon, received");
  for (const Json& item : vectors["commands"]) {
    FalconScanner scanner(0x50);
    const auto frames = scan(scanner, item["hex"]);
    check.equal("commands in one packet", static_cast<double>(frames.size()), 1.0, 0.0);
    if (frames.empty()) continue;
    const FalconCommand command = decode_command(frames[0]);
    for (std::size_t i = 0; i < 3; ++i)
      check.equal("motor", command.motor[i], item["motors_sent"][i], 0.0);
    check.equal("homing", command.homing, item["homing"].get<bool>(), 0.0);
    check.equal("leds", command.leds, item["leds"], 0.0);
  }
  check.begin("Falcon, sent");
  for (const Json& item : vectors["reports"])
    check.same("report", hex_of(encode_report(report_of(item))), item["hex"]);
  for (const Json& item : vectors["ftdi"]["baud"])
    check.equal("baud", ftdi_baud(item["wValue"]), item["baud"], 1e-6);
  for (const Json& item : vectors["strip"])
    check.same("transfer", transfer_of(item), item["transfer"]);
  check.begin("Falcon, damaged streams");
  for (const Json& item : vectors["streams"]) {
    FalconScanner scanner(0xC0);
    std::string own, theirs;
    for (const Json& chunk : item["chunks"])
      for (const FalconFrame& frame : scan(scanner, chunk))
        own += hex_of(encode_report(decode_report(frame)));
    for (const Json& report : item["reports"]) theirs += hex_of(encode_report(report_of(report)));
    check.same("reports", own, theirs);
  }
  check.begin("Falcon, from reset to report");
  check_boot(check, vectors["ftdi"]);
}

}  // namespace tact::rig
