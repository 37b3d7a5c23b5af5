// SPDX-License-Identifier: Apache-2.0
#include "hal/moteus/moteus_bring_up.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "hal/can/can_delta.h"
#include "model/time_ns.h"

namespace tact::hal::moteus {
namespace {

using model::Error;
using model::Result;

constexpr int kAsk_ms = 5;
constexpr int kHear_ms = 1000, kKind_ms = 300, kStop_ms = 500, kRest_ms = 200;
constexpr double kRest_turns = 0.02;        // of a motor while the arms shall rest
constexpr double kMinAnswered_ratio = 0.8;  // of the questions
constexpr std::uint8_t kReplyBytes = 24;

/// One axis, as its frames report it.
struct Heard {
  int node = 0;
  int asked = 0, replies = 0, stopped = 0;
  MoteusReply last{};                 // what every tick asks for
  std::optional<MoteusReply> kind{};  // what moteus_ask_kind asks for
  double least_turns = 0.0, most_turns = 0.0;

  bool is_in(MoteusMode mode) const { return last.mode == static_cast<int>(mode); }
  void forget() { asked = replies = stopped = 0; }
};

class BringUp {
 public:
  using Message = std::optional<can::CanFdFrame> (*)(int node);
  using Condition = bool (*)(const Heard&);

  BringUp(can::CanFdBus& bus, const can::CanSettings& can) : bus_(bus), can_(can) {
    for (std::size_t i = 0; i < 3; ++i) axes_[i].node = can.node[i];
  }

  Result<MoteusStart> run() {
    using Step = std::optional<Error> (BringUp::*)();
    for (const Step step : {&BringUp::hear_all, &BringUp::check_kind, &BringUp::stop_all,
                            &BringUp::check_position, &BringUp::watch_rest}) {
      if (auto error = (this->*step)()) return *error;
      if (bus_.fault() != Fault::kNone)
        return Error{
            can::can_bus_fault_detail(bus_.cause(), can_.interface, can::CanFdFrame::kLinkType)};
    }
    for (std::size_t i = 0; i < 3; ++i) start_.motor_turns[i] = *axes_[i].last.position_turns;
    return start_;
  }

 private:
  std::optional<Error> hear_all() {
    const auto heard = [](const Heard& a) { return a.replies > 0; };
    if (run_until(moteus_ask, heard, kHear_ms)) return {};
    if (std::ranges::none_of(axes_, heard)) return Error{silent_bus_detail(bus_, can_.interface)};
    return wrong([](const Heard& a) { return a.replies == 0; },
                 "does not answer: is it on, and is this its id.id?");
  }

  std::optional<Error> check_kind() {
    const auto reported = [](const Heard& a) {
      return a.kind && (a.kind->refused_register || (a.kind->home_state && a.kind->register_map));
    };
    run_until(moteus_ask_kind, reported, kKind_ms);
    if (auto error = wrong(
            [](const Heard& a) { return !a.kind || a.kind->register_map != kMoteusRegisterMap; },
            "does not speak register map 5: install its vendor's firmware of today")) {
      return error;
    }
    if (can_.homing != can::Homing::kAbsolute) return {};
    return wrong(
        [](const Heard& a) { return a.kind->home_state != static_cast<int>(MoteusHome::kOutput); },
        "counts its position from power-on, or from the rotor: homing "
        "\"absolute\" needs an encoder at the output; use \"jig\"");
  }

  /// A fault ends with the stop, so a drive that was in one is reported.
  std::optional<Error> stop_all() {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!axes_[i].is_in(MoteusMode::kFault)) continue;
      start_.caution += fmt::format("{}{} was in fault, which is cleared now: {}",
                                    start_.caution.empty() ? "" : "; ", can::can_arm_name(i, can_),
                                    moteus_fault_message(axes_[i].last.fault.value_or(0)));
    }
    for (Heard& axis : axes_) axis.forget();
    // The first reply holds the state before its stop.
    run_until(moteus_stop_and_ask, [](const Heard& a) { return a.stopped > 1; }, kStop_ms);
    for (std::size_t i = 0; i < 3; ++i) {
      const Heard& axis = axes_[i];
      if (!axis.is_in(MoteusMode::kFault)) continue;
      return Error{fmt::format("{}: {}", can::can_arm_name(i, can_),
                               moteus_fault_message(axis.last.fault.value_or(0)))};
    }
    return wrong([](const Heard& a) { return a.stopped < 2; },
                 "does not stop: end the program that drives it, then start tactd again");
  }

  std::optional<Error> check_position() {
    if (auto error = wrong([](const Heard& a) { return !a.last.position_turns; },
                           "does not know its position: moteus_tool --calibrate, and check its "
                           "encoder")) {
      return error;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (const char* what = lacking_in(axes_[i].last)) {
        return Error{
            fmt::format("{} answers without its {}: install its vendor's firmware of today",
                        can::can_arm_name(i, can_), what)};
      }
    }
    return {};
  }

  std::optional<Error> watch_rest() {
    for (Heard& axis : axes_) axis.forget();
    run_until(moteus_stop_and_ask, [](const Heard&) { return false; }, kRest_ms);
    for (std::size_t i = 0; i < 3; ++i) {
      const Heard& axis = axes_[i];
      if (axis.replies >= kMinAnswered_ratio * axis.asked) continue;
      return Error{
          fmt::format("{} answers {} of {} questions: check the CAN cable and both 120 "
                      "ohm terminators, and that no other program asks it",
                      can::can_arm_name(i, can_), axis.replies, axis.asked)};
    }
    if (auto error =
            wrong([](const Heard& a) { return a.stopped != a.replies; },
                  "starts by itself: end the program that drives it, then start tactd again")) {
      return error;
    }
    if (can_.homing != can::Homing::kJig) return {};
    return wrong([](const Heard& a) { return a.most_turns - a.least_turns > kRest_turns; },
                 can::kMovesOnJig);
  }

  /// Asks and listens until all three fit: true, or the time is over or the bus broke: false.
  bool run_until(Message message, Condition fits, int time_ms) {
    can::CanFdSocket& socket = bus_.socket();
    const std::int64_t end_ns = socket.now_ns() + time_ms * model::kMillisecond_ns;
    while (bus_.fault() == Fault::kNone) {
      for (const can::CanFdReceived& one : bus_.receive()) take(one.frame);
      if (std::ranges::all_of(axes_, fits)) return true;
      const std::int64_t now_ns = socket.now_ns();
      if (now_ns >= end_ns) return false;
      if (now_ns >= ask_ns_) {
        ask_ns_ = now_ns + kAsk_ms * model::kMillisecond_ns;
        for (Heard& axis : axes_) {
          bus_.push(message(axis.node));
          ++axis.asked;
        }
        bus_.send();
      }
      socket.wait(kAsk_ms);
    }
    return false;
  }

  void take(const can::CanFdFrame& frame) {
    for (Heard& axis : axes_) {
      const auto reply = decode_moteus(frame, axis.node);
      if (!reply) continue;
      if (!reply->mode) {
        const bool reports = reply->home_state || reply->register_map || reply->refused_register;
        if (reports) axis.kind = reply;  // else it only acknowledges a stop
        continue;
      }
      axis.last = *reply;
      axis.stopped += axis.is_in(MoteusMode::kStopped) ? 1 : 0;
      const double turns = reply->position_turns.value_or(0.0);
      const bool first = axis.replies++ == 0;
      axis.least_turns = first ? turns : std::min(axis.least_turns, turns);
      axis.most_turns = first ? turns : std::max(axis.most_turns, turns);
    }
  }

  /// The first drive that `is_wrong`.
  std::optional<Error> wrong(Condition is_wrong, const char* words) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (is_wrong(axes_[i])) return Error{fmt::format("{} {}", can::can_arm_name(i, can_), words)};
    return std::nullopt;
  }

  can::CanFdBus& bus_;
  const can::CanSettings& can_;
  std::array<Heard, 3> axes_;
  std::int64_t ask_ns_ = 0;
  MoteusStart start_;
};

}  // namespace

std::vector<std::uint32_t> moteus_ids(const can::CanSettings& can) {
  return {moteus_reply_id(can.node[0]), moteus_reply_id(can.node[1]), moteus_reply_id(can.node[2])};
}

can::CanFdBits moteus_cycle_bits(const can::CanSettings& can) {
  can::CanFdBits all;
  for (const int node : can.node) {
    const auto command = moteus_torque(node, 0.0, 1.0).value_or(can::CanFdFrame{});
    const can::CanFdFrame reply{.id = moteus_reply_id(node), .length = kReplyBytes, .data = {}};
    for (const can::CanFdFrame& frame : {command, reply}) {
      const can::CanFdBits bits = most_can_fd_bits(frame);
      all.slow += bits.slow;
      all.fast += bits.fast;
    }
  }
  return all;
}

const char* lacking_in(const MoteusReply& reply) RT_SAFE {
  if (!reply.mode) return "mode";
  if (!reply.position_turns) return "position";
  if (!reply.velocity_turns_per_s) return "velocity";
  if (!reply.torque_Nm) return "torque";
  if (!reply.voltage_V) return "voltage";
  if (!reply.temperature_C) return "temperature";
  return reply.fault ? nullptr : "fault code";
}

Result<MoteusStart> bring_up_moteus(can::CanFdBus& bus, const can::CanSettings& can) {
  for (const int node : can.node) {
    if (node >= kMoteusSmallestNode && node <= kMoteusLargestNode) continue;
    return Error{fmt::format("device.can.node has {}, but a moteus' id.id is {} to {}", node,
                             kMoteusSmallestNode, kMoteusLargestNode)};
  }
  if (can.homing == can::Homing::kIndex) {
    return Error{
        "device.can.homing \"index\" is for drives that search their pulse themselves; with moteus "
        "use \"absolute\" (an encoder at the output) or \"jig\""};
  }
  return BringUp(bus, can).run();
}

}  // namespace tact::hal::moteus
