// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/cia402_network.h"

#include <fmt/core.h>

#include <algorithm>

#include "hal/can/can_delta.h"
#include "hal/cia402/canopen_text.h"

namespace tact::hal::cia402 {
namespace {

using model::Error;

// Chosen: for 50 heartbeats; for a node to boot.
constexpr int kOperational_ms = 500, kBoot_ms = 3000, kLook_ms = 10;

}  // namespace

Error Cia402Network::wrong(std::size_t i, const std::string& words) const {
  // A bus that failed makes every drive look silent: it is reported, not the drive.
  if (bus_.fault() != Fault::kNone)
    return Error{can::can_bus_fault_detail(bus_.cause(), can_.interface)};
  return Error{fmt::format("{} {}", can::can_arm_name(i, can_), words)};
}

std::optional<Error> Cia402Network::find_all() {
  for (const int node : can_.node) bus_.push(canopen_nmt(NmtCommand::kPreOperational, node));
  bus_.send();
  // All three are asked before one is blamed: when none answers it is the bus.
  std::array<bool, 3> answers{};
  for (std::size_t i = 0; i < 3; ++i) {
    SdoFailure failure;
    // An abort is an answer, too: the node is there.
    answers[i] = sdo_.read(can_.node[i], {0x1000, 0, 4}, failure).has_value() || !failure.silent;
  }
  if (std::none_of(answers.begin(), answers.end(), [](bool yes) { return yes; }))
    return Error{silent_bus_detail(bus_, can_.interface)};
  for (std::size_t i = 0; i < 3; ++i)
    if (!answers[i]) return wrong(i, "does not answer: is it on, and does it have this node?");
  return std::nullopt;
}

bool Cia402Network::start_all() {
  for (const int node : can_.node) bus_.push(canopen_nmt(NmtCommand::kStart, node));
  bus_.send();
  // The command has no reply, and a heartbeat from before it proves nothing.
  said_ = {};
  for (int waited_ms = 0; waited_ms < kOperational_ms; waited_ms += kLook_ms) {
    sdo_.wait(kLook_ms);
    if (is_operational(0) && is_operational(1) && is_operational(2)) return true;
  }
  return false;
}

void Cia402Network::reset_idle() {
  for (std::size_t i = 0; i < 3; ++i) {
    booted_[i] = is_operational(i);  // and is not asked
    if (!booted_[i]) bus_.push(canopen_nmt(NmtCommand::kResetCommunication, can_.node[i]));
  }
  bus_.send();
  for (int waited_ms = 0; waited_ms < kBoot_ms; waited_ms += kLook_ms) {
    sdo_.wait(kLook_ms);
    if (booted_[0] && booted_[1] && booted_[2]) return;
  }
}

Error Cia402Network::not_started() {
  std::size_t i = 0;
  while (i < 2 && is_operational(i)) ++i;
  if (!said_[i])
    return wrong(i, "does not say that it is operational: does it send its heartbeat (1017)?");
  SdoFailure none;  // an optional setting
  const auto noted = sdo_.read(can_.node[i], {0x1003, 1, 4}, none);
  const auto code = static_cast<std::uint16_t>(noted.value_or(0));
  if (code == 0)
    return wrong(i,
                 "does not become operational: is a second controller on the bus? Else switch "
                 "it off and on");
  return wrong(i,
               fmt::format("does not become operational and notes an error: {} (code 0x{:04X} in "
                           "object 1003). Then switch it off and on",
                           emergency_message(code), code));
}

void Cia402Network::take(const can::CanFrame& frame) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto state = decode_canopen_heartbeat(frame, can_.node[i]);
    if (!state) continue;
    said_[i] = state;
    booted_[i] = booted_[i] || *state == NmtState::kBoot;
  }
}

}  // namespace tact::hal::cia402
