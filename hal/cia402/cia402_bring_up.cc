// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/cia402_bring_up.h"

#include <fmt/core.h>

#include <cmath>

#include "hal/can/can_delta.h"
#include "hal/cia402/canopen_text.h"
#include "hal/cia402/cia402_network.h"
#include "hal/cia402/cia402_state.h"
#include "hal/cia402/drive_settings.h"
#include "hal/cia402/sdo_client.h"
#include "model/time_ns.h"

namespace tact::hal::cia402 {
namespace {

using model::Error;
using model::Result;

// Chosen: for a fault reaction to end, between two looks at a resting arm.
constexpr int kSettle_ms = 1000, kRest_ms = 100;
// Turns of a motor between two looks at resting arms; a free arm of DK-8 falls by 0.3.
constexpr double kRest_turns = 0.02;
// The profile is the lower half of object 1000. Bit 9 of 6502: cyclic synchronous torque.
constexpr std::uint32_t kProfile402 = 402, kCstModeBit = 1u << 9;
constexpr SdoEntry kDeviceType{0x1000, 0, 4};

class BringUp {
 public:
  BringUp(can::CanBus& bus, const model::DeviceSettings& settings, double rate_Hz)
      : bus_(bus),
        can_(settings.of<can::CanSettings>()),
        own_(settings.of<Cia402Settings>()),
        rate_Hz_(rate_Hz),
        network_(bus, can_) {}

  Result<Cia402Start> run() {
    for (const bool last : {false, true}) {
      Cia402Start start;
      if (auto error = set_up(start)) return *error;
      start.caution = settings_.caution();
      // Last: PDOs flow in operational alone, so no drive takes a torque before all are set up.
      if (network_.start_all()) return start;
      if (!last) network_.reset_idle();
    }
    return network_.not_started();
  }

 private:
  std::optional<Error> set_up(Cia402Start& start) {
    if (auto error = network_.find_all()) return error;
    for (std::size_t i = 0; i < 3; ++i) {
      for (const auto step : {&BringUp::identify, &BringUp::configure, &BringUp::make_calm})
        if (auto error = (this->*step)(i)) return error;
      if (auto error = learn(i, start)) return error;
    }
    // After all are calm: arms that have just lost their power may still be falling.
    return rest(start);
  }

  Error wrong(std::size_t i, const std::string& words) const { return network_.wrong(i, words); }

  std::optional<Error> get(std::size_t i, const SdoEntry& entry, std::uint32_t& value) {
    SdoFailure failure;
    const auto got = sdo_.read(can_.node[i], entry, failure);
    if (!got) return wrong(i, sdo_failure_text(failure, entry.index, entry.sub));
    value = *got;
    return std::nullopt;
  }
  std::optional<Error> set(std::size_t i, const SdoWrite& what) {
    const auto failure = sdo_.write(can_.node[i], what);
    if (failure) return wrong(i, sdo_failure_text(*failure, what.index, what.sub));
    return std::nullopt;
  }

  std::optional<Error> identify(std::size_t i) {
    std::uint32_t type = 0;
    if (auto error = get(i, kDeviceType, type)) return error;
    if ((type & 0xFFFFu) != kProfile402) {
      return wrong(i,
                   fmt::format("is no CiA 402 drive (device type 0x{:08X}): is it the right node, "
                               "and is its profile 402 switched on?",
                               type));
    }
    // Not every drive has 6502 (CN-5); DriveSettings looks at 6061 besides.
    SdoFailure none;  // an optional setting
    const auto modes = sdo_.read(can_.node[i], {0x6502, 0, 4}, none);
    if (modes && (*modes & kCstModeBit) == 0) {
      return wrong(i,
                   "cannot do cyclic synchronous torque: update its firmware, or take a drive "
                   "that can");
    }
    return std::nullopt;
  }

  std::optional<Error> configure(std::size_t i) {
    const auto words = settings_.write(can_.node[i], cst_settings(own_, rate_Hz_));
    if (words) return wrong(i, *words);
    return std::nullopt;
  }

  /// Without power and without an old fault.
  std::optional<Error> make_calm(std::size_t i) {
    const auto command = [this, i](std::uint16_t word) {
      return set(i, {.index = 0x6040, .sub = 0, .value = word, .size = 2});
    };
    std::uint32_t status = 0;
    if (auto error = command(kControlDisableVoltage)) return error;
    const std::int64_t end_ns = bus_.socket().now_ns() + kSettle_ms * model::kMillisecond_ns;
    bool reset = false;
    while (true) {
      if (auto error = get(i, {0x6041, 0, 2}, status)) return error;
      const Cia402State state = cia402_state(static_cast<std::uint16_t>(status));
      // In both the motor has no power.
      if (state == Cia402State::kSwitchOnDisabled || state == Cia402State::kReady)
        return std::nullopt;
      if (state == Cia402State::kFault && !reset) {
        reset = true;  // once: a fault that comes back is present, and is reported
        if (auto error = command(kControlFaultReset)) return error;
        // Bit 7 acts as it rises (CN-2), so it goes down again.
        if (auto error = command(kControlDisableVoltage)) return error;
      }
      if (bus_.socket().now_ns() > end_ns) return not_calm(i, state);
      sdo_.wait(10);
    }
  }

  Error not_calm(std::size_t i, Cia402State state) {
    std::uint32_t code = 0;
    if (state == Cia402State::kFault && !get(i, {0x603F, 0, 2}, code) && code != 0) {
      return wrong(i, fmt::format("keeps a fault: {} (code 0x{:04X})",
                                  emergency_message(static_cast<std::uint16_t>(code)), code));
    }
    return wrong(i, fmt::format("stays in state {}: switch it off and on, and read its errors with "
                                "its vendor's program",
                                cia402_state_name(state)));
  }

  /// The torque that 6071 calls 1000, and the position. What the user states goes before 6076,
  /// which some drives lack and others fill with a default.
  std::optional<Error> learn(std::size_t i, Cia402Start& start) {
    start.rated_torque_Nm[i] = own_.rated_torque_Nm;
    if (start.rated_torque_Nm[i] > 0.0) return position(i, start.motor_turns[i]);
    SdoFailure failure;
    const auto rated_mNm = sdo_.read(can_.node[i], {0x6076, 0, 4}, failure);
    if (!rated_mNm && failure.silent) return wrong(i, sdo_failure_text(failure, 0x6076, 0));
    if (!rated_mNm || *rated_mNm == 0) {
      return wrong(i, fmt::format("{}: set device.can.rated_torque_Nm to the torque that its "
                                  "manual calls 1000 of object 6071",
                                  rated_mNm ? "has a rated torque of zero (object 6076)"
                                            : "does not report its rated torque (object 6076)"));
    }
    start.rated_torque_Nm[i] = 1e-3 * *rated_mNm;
    return position(i, start.motor_turns[i]);
  }

  std::optional<Error> position(std::size_t i, double& turns) {
    std::uint32_t counts = 0;
    if (auto error = get(i, {0x6064, 0, 4}, counts)) return error;
    // 6064 is signed; SDO carries its bits.
    turns = static_cast<std::int32_t>(counts) / own_.counts_per_motor_turn;
    return std::nullopt;
  }

  /// On a jig the position of now is the zero of the arms: one that still falls would shift it.
  std::optional<Error> rest(Cia402Start& start) {
    // An absolute encoder's zero does not depend on where the arms are now.
    if (can_.homing != can::Homing::kJig) return std::nullopt;
    sdo_.wait(kRest_ms);
    for (std::size_t i = 0; i < 3; ++i) {
      const double before_turns = start.motor_turns[i];
      if (auto error = position(i, start.motor_turns[i])) return error;
      if (std::abs(start.motor_turns[i] - before_turns) > kRest_turns)
        return wrong(i, can::kMovesOnJig);
    }
    return std::nullopt;
  }

  can::CanBus& bus_;
  const can::CanSettings& can_;
  const Cia402Settings& own_;
  double rate_Hz_;
  Cia402Network network_;
  SdoClient& sdo_ = network_.sdo();
  DriveSettings settings_{sdo_};
};

}  // namespace

std::vector<std::uint32_t> cia402_ids(const can::CanSettings& can) {
  std::vector<std::uint32_t> ids;
  for (const int node : can.node)
    for (const std::uint32_t base : {0x080u, 0x180u, 0x580u, 0x700u})  // EMCY TPDO SDO heartbeat
      ids.push_back(base + static_cast<std::uint32_t>(node));
  // Another sender of these is a fault.
  ids.push_back(host_heartbeat_id({}));
  ids.insert(ids.end(), kCanopenForAll.begin(), kCanopenForAll.end());
  for (const int node : can.node)
    for (const std::uint32_t base : kCanopenToNode)
      ids.push_back(base + static_cast<std::uint32_t>(node));
  return ids;
}

int cia402_cycle_bits() {
  // SYNC, three commands, three samples (CB-2).
  return can::most_can_bits(0) + 3 * (can::most_can_bits(4) + can::most_can_bits(8));
}

CstConfiguration cst_settings(const Cia402Settings& settings, double rate_Hz) {
  CstConfiguration out;
  // 60C2 takes whole ms; bring_up_cia402 has refused every other rate.
  out.period_ms = static_cast<std::uint8_t>(std::lround(1000.0 / rate_Hz));
  out.command_transmission_type = settings.command_at_sync ? 1 : 255;
  return out;
}

Result<Cia402Start> bring_up_cia402(can::CanBus& bus, const model::DeviceSettings& settings,
                                    double rate_Hz) {
  const auto& can = settings.of<can::CanSettings>();
  const double period_ms = 1000.0 / rate_Hz;
  if (!(period_ms >= 1.0 && period_ms <= 10.0) || period_ms != std::floor(period_ms)) {
    return Error{fmt::format(
        "rate_Hz is {}, but SYNC of CiA 402 drives has a period of 1 to 10 whole ms: take 1000, "
        "500, 250, 200, 125 or 100",
        rate_Hz)};
  }
  for (const int node : can.node) {
    if (is_canopen_node(node) && node != CstConfiguration{}.host_node) continue;
    return Error{fmt::format(
        "device.can.node has {}, but a CANopen drive's node is 1 to 126 (127 is tactd's)", node)};
  }
  if (can.homing == can::Homing::kIndex) {
    return Error{
        "device.can.homing \"index\" is for ODrives: CiA 402 drives need \"absolute\" or \"jig\""};
  }
  return BringUp(bus, settings, rate_Hz).run();
}

}  // namespace tact::hal::cia402
