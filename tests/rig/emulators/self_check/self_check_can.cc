// SPDX-License-Identifier: Apache-2.0
// self_check_can.cc - the vectors of CANSimple and CiA 402, from the side of the drive: what a host
// sends is decoded, what a drive sends is encoded.
#include "tests/rig/emulators/cia402/cia402_drive.h"
#include "tests/rig/emulators/odrive/odrive_table.h"
#include "tests/rig/emulators/self_check/self_check.h"

namespace tact::rig {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

std::string payload_of(const OdriveMessage& message, const Json& expect) {
  Bytes payload(message.size);
  for (const WireField& field : message.used()) {
    if (!expect.contains(field.name)) continue;
    const Json& value = expect[std::string(field.name)];
    put_field(payload, field,
              value.is_boolean() ? static_cast<double>(value.get<bool>()) : value.get<double>());
  }
  return hex_of(payload);
}

constexpr WireField kStatus{"", 0, WireType::kU16};

std::uint8_t heartbeat_of(const std::string& state) {
  if (state == "boot") return 0;
  if (state == "stopped") return 4;
  return state == "operational" ? 5 : 0x7F;
}

/// What the server answers when the object has this value.
Sdo upload_of(const Json& expect) {
  ObjectDictionary dictionary(expect["node"], 0.32);
  const Bytes raw = bytes_of_hex(expect["raw"]);
  const WireType type = raw.size() == 4 ? WireType::kI32 : WireType::kU16;
  const double value = get_field(raw, {"", 0, raw.size() == 1 ? WireType::kU8 : type});
  dictionary.set(expect["index"], expect["sub"], static_cast<std::int64_t>(value));
  Sdo request{0x40};
  put_raw(std::span(request).subspan(1, 2), expect["index"].get<std::uint64_t>());
  request[3] = expect["sub"];
  return dictionary.serve(request, false);
}

}  // namespace

int check_drives(const std::string& folder) {
  return run_self_check(folder, [](SelfCheck& check) {
    check_odrive(check);
    check_cia402(check);
    check_moteus(check);
    check_delta_kinematics(check);
  });
}

void check_odrive(SelfCheck& check) {
  const Json vectors = check.load("can_odrive.json");
  check.begin("CANSimple, received");
  for (const Json& item : vectors["encode"]) {
    std::string name = item["message"];
    const std::uint32_t id = item["id"];
    const Bytes payload = bytes_of_hex(item["data"]);
    check.equal(name + " node", id >> 5u, item["args"]["node"], 0.0);
    if (name.starts_with("rtr_")) {
      const OdriveMessage* const reply =
          odrive_reply(static_cast<std::uint8_t>(id & 31u), OdriveGeneration::k06);
      check.same(name, reply == nullptr ? "none" : "rtr_" + std::string(reply->name), name);
      continue;
    }
    if (name.ends_with("_dlc4")) name.resize(name.size() - 5);
    const OdriveMessage* const message = odrive_message(name, OdriveFrom::kHost);
    check.same(name + " known", message == nullptr ? "no" : "yes", "yes");
    if (message == nullptr) continue;
    check.equal(name + " command", message->command, id & 31u, 0.0);
    for (const WireField& field : message->used()) {
      const double sent = item["args"][std::string(field.name)];
      const double step = field.type == WireType::kF32 ? 1e-6 * std::abs(sent) : 0.5 * field.scale;
      check.equal(name + "." + std::string(field.name), get_field(payload, field), sent,
                  step + 1e-12);
    }
  }
  check.begin("CANSimple, sent");
  for (const Json& item : vectors["decode"]) {
    const Json& expect = item["expect"];
    const OdriveMessage* const message =
        odrive_message(expect["name"].get<std::string>(), OdriveFrom::kDrive);
    check.same(expect["name"], message == nullptr ? "none" : payload_of(*message, expect),
               item["data"]);
    if (message != nullptr)
      check.equal("identifier", expect["node"].get<unsigned>() << 5u | message->command, item["id"],
                  0.0);
  }
  for (const Json& item : vectors["heartbeat_v0_5"])
    check.same("heartbeat 0.5",
               payload_of(*odrive_message("heartbeat_v0_5", OdriveFrom::kDrive), item["expect"]),
               item["data"]);
}

namespace {

void check_configuration(SelfCheck& check, const Json& vectors, ObjectDictionary& dictionary) {
  check.begin("CiA 402, configuration");
  for (const Json& item : vectors["config_sequence_node5"]) {
    const Bytes request = bytes_of_hex(item["frame"]);
    const auto answer = dictionary.serve(request, false);
    Bytes good{0x60, request[1], request[2], request[3], 0, 0, 0, 0};
    check.same("answer to " + item["frame"].get<std::string>(), hex_of(answer), hex_of(good));
    // A 1 byte value may be written as 253 and be -3.
    const std::int64_t stored = dictionary.get(item["index"], item["sub"]);
    const std::int64_t bits = 8 * item["size"].get<std::int64_t>();
    check.equal("value", static_cast<double>(stored & ((std::int64_t{1} << bits) - 1)),
                item["value"], 0.0);
  }
}

void check_received(SelfCheck& check, const Json& vectors, ObjectDictionary& dictionary) {
  check.begin("CiA 402, received");
  for (const Json& item : vectors["encode"]) {
    const std::string name = item["message"];
    const Bytes payload = bytes_of_hex(item["data"]);
    const Json& args = item["args"];
    if (name == "rpdo1_cst") {
      check.same(name, dictionary.unpack(0x1600, payload) ? "mapped" : "other length", "mapped");
      check.equal(name, static_cast<double>(dictionary.get(0x6040)), args["controlword"], 0.0);
      check.equal(name, static_cast<double>(dictionary.get(0x6071)), args["torque_permille"], 0.0);
    } else if (name.starts_with("sdo_")) {
      // Through the server: any answer is about the same object.
      const auto answer = ObjectDictionary(args["node"], 0.32).serve(payload, false);
      check.equal(name + " index", static_cast<double>(get_raw(std::span(answer).subspan(1, 2))),
                  args["index"], 0.0);
      check.equal(name + " sub", answer[3], args["sub"], 0.0);
    }
  }
}

void check_sent(SelfCheck& check, const Json& vectors, ObjectDictionary& dictionary) {
  check.begin("CiA 402, sent");
  for (const Json& item : vectors["decode"]) {
    const std::string name = item["message"];
    const Json& expect = item["expect"];
    std::array<std::uint8_t, 8> own{};
    std::size_t size = bytes_of_hex(item["data"]).size();
    if (name == "tpdo1_cst") {
      const Bytes payload = bytes_of_hex(item["data"]);
      dictionary.set(0x6041, 0, static_cast<std::int64_t>(get_field(payload, kStatus)));
      dictionary.set(0x6064, 0, expect["position"]);
      dictionary.set(0x6077, 0, expect["torque_permille"]);
      size = dictionary.pack(0x1A00, own);
    } else if (name == "emcy") {
      own = cia402_emergency(expect["code"], expect["error_register"],
                             bytes_of_hex(expect["manufacturer"]));
    } else if (name == "heartbeat") {
      own[0] = heartbeat_of(expect["state"]);
    } else if (expect["kind"] == "abort") {
      own =
          sdo_abort(expect["index"], expect["sub"], SdoAbort{expect["code"].get<std::uint32_t>()});
    } else if (expect["kind"] == "upload") {
      own = upload_of(expect);
    } else {
      own = {0x60};  // as the configuration above has it
      put_raw(std::span(own).subspan(1, 2), expect["index"].get<std::uint64_t>());
      own[3] = expect["sub"];
    }
    check.same(name, hex_of(std::span(own).first(size)), item["data"]);
  }
}

void check_states(SelfCheck& check, const Json& vectors) {
  check.begin("CiA 402, states");
  using enum Cia402State;
  const std::pair<Cia402State, std::string> names[] = {{kSwitchOnDisabled, "switch_on_disabled"},
                                                       {kReady, "ready_to_switch_on"},
                                                       {kSwitchedOn, "switched_on"},
                                                       {kOperationEnabled, "operation_enabled"},
                                                       {kQuickStop, "quick_stop_active"},
                                                       {kFault, "fault"}};
  // The words a host answers with lead from a fault to enabled operation.
  Cia402State state = kFault;
  std::uint16_t previous = 0;
  for (int step = 0; step < 4; ++step) {
    for (const Json& item : vectors["states"]) {
      if (item["state"] != names[static_cast<std::size_t>(state)].second ||
          item["next_controlword"].is_null())
        continue;
      const auto word = item["next_controlword"].get<std::uint16_t>();
      state = cia402_next(state, word, previous);
      previous = word;
      break;
    }
  }
  check.same("the host's words", names[static_cast<std::size_t>(state)].second,
             "operation_enabled");
  for (const Json& item : vectors["states"])
    for (const auto& [own, name] : names)
      if (item["statusword"] == (cia402_statusword(own) & 0x6F))
        check.same("statusword of " + name, name, item["state"]);
}

}  // namespace

void check_cia402(SelfCheck& check) {
  const Json vectors = check.load("can_cia402.json");
  ObjectDictionary dictionary(5, 0.32);
  check_configuration(check, vectors, dictionary);
  check_received(check, vectors, dictionary);
  check_sent(check, vectors, dictionary);
  check_states(check, vectors);
}

}  // namespace tact::rig
