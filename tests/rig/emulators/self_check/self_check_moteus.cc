// SPDX-License-Identifier: Apache-2.0
// self_check_moteus.cc - the vectors of moteus, from the side of the drive: what a host sends is
// served, what a drive replies is made.
#include <map>

#include "tests/rig/emulators/moteus/moteus_registers.h"
#include "tests/rig/emulators/self_check/self_check.h"

namespace tact::rig {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kWrites = 23;  // bytes of a torque's frame that come before its question

/// Registers that hold what is written.
class Memory final : public MoteusRegisters {
 public:
  std::optional<double> get(std::uint16_t number) const override {
    const auto found = values.find(number);
    return found == values.end() ? std::nullopt : std::optional(found->second);
  }
  bool set(std::uint16_t number, double value) override {
    values[number] = value;
    return true;
  }
  double at(std::uint16_t number) const { return get(number).value_or(-1e9); }

  std::map<std::uint16_t, double> values;
};

}  // namespace

void check_moteus(SelfCheck& check) {
  const Json vectors = check.load("can_moteus.json");
  std::string question;
  check.begin("moteus, received");
  for (const Json& item : vectors["encode"]) {
    const std::string name = item["message"];
    Memory memory;
    serve_moteus(bytes_of_hex(item["data"]), memory);
    check.equal("servo", item["id"].get<int>() & 0x7F, item["args"]["servo"], 0.0);
    if (name == "stop") {
      check.equal("stop, mode", memory.at(0x000), 0.0, 0.0);
      check.equal("stop, registers", static_cast<double>(memory.values.size()), 1.0, 0.0);
      continue;
    }
    check.equal("mode", memory.at(0x000), 10.0, 0.0);
    check.equal("torque", memory.at(0x022), item["args"]["torque"], 1e-6);
    check.equal("kp", memory.at(0x023), 0.0, 0.0);
    check.equal("kd", memory.at(0x024), 0.0, 0.0);
    check.equal("watchdog", memory.at(0x027), item["args"]["watchdog_s"], 1e-8);
    question = item["data"];
  }
  check.begin("moteus, sent");
  for (const Json& item : vectors["decode"]) {
    const Json& expect = item["expect"];
    check.equal("identifier", expect["source"].get<int>() << 8 | expect["destination"].get<int>(),
                item["id"], 0.0);
    Memory memory;
    for (const auto& [number, value] : expect["registers"].items()) {
      const auto at = static_cast<std::uint16_t>(std::stoi(number, nullptr, 16));
      memory.values[at] = value.get<double>() * (at == 0x00D ? 0.5 : 1.0);
    }
    const auto bytes = bytes_of_hex(question);
    const auto reads = std::span(bytes).subspan(kWrites);
    check.same("reply", hex_of(serve_moteus(reads, memory)), item["data"]);
  }
}

}  // namespace tact::rig
