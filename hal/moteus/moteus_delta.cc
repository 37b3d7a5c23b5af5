// SPDX-License-Identifier: Apache-2.0
#include "hal/moteus/moteus_delta.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "hal/can/can_device.h"
#include "hal/can/can_open.h"
#include "hal/can/excess_torque.h"
#include "hal/moteus/moteus_bring_up.h"
#include "hal/moteus/moteus_protocol.h"
#include "model/time_ns.h"

namespace tact::hal::moteus {
namespace {

using can::CanPower;
using model::Error;
using model::Result;
using Loop = can::CanFdLoop;

constexpr double kWatchdog_s = 0.010;
constexpr double kMinRate_Hz = 500.0;  // then the watchdog spans five periods
constexpr std::int64_t kSilence_ns = 100'000'000;
constexpr int kSettledTicks = 10;   // in position mode and without torque, before a force may pass
constexpr int kMaxIncomplete = 10;  // replies in a row

constexpr int kLowSupplyFault = 40;

/// Kinds of FaultCause, after those that all drives have.
enum class MoteusCause : std::uint8_t {
  kFault = static_cast<std::uint8_t>(can::CanCause::kFirstOwn),  // code: of register 0x00F
  kTimeout,
  kLeftPosition,  // code: the mode it is in
  kNotStarted,    // code: the mode it is in
  kExcessTorque,  // code: mN m
  kIncomplete,    // replies that lack what was asked for
  kLowSupply,     // waited for, before any force; code: of register 0x00F
};

class Moteuses final : public can::CanFdDrives {
 public:
  Moteuses(const can::CanSettings& can, double largest_torque_Nm)
      : nodes_(can.node), max_excess_Nm_(can::kMaxExcess_ratio * largest_torque_Nm) {}

  int node_of(const can::CanFdFrame& frame) const RT_SAFE override {
    return moteus_address(frame).source;
  }

  bool take(Loop& loop, std::size_t at, const can::CanFdFrame& frame,
            std::int64_t arrival_ns) RT_SAFE override {
    const auto reply = decode_moteus(frame, nodes_[at]);
    if (!reply) return false;
    if (arrival_ns < loop.before_ns || !loop.axes[at].beat(arrival_ns)) {
      ++old_;
      return true;
    }
    Axis& axis = axes_[at];
    axis.mode = reply->mode.value_or(axis.mode);  // also without a position a fault is reported
    axis.fault = reply->fault.value_or(axis.fault);
    if (lacking_in(*reply) != nullptr) {
      ++incomplete_;
      axis.settled = 0;
      if (++axis.incomplete >= kMaxIncomplete) loop.fail(at, MoteusCause::kIncomplete, 0);
      return true;
    }
    extra_ += loop.axes[at].sampled ? 1 : 0;
    loop.axes[at].replies.add_reply();
    loop.axes[at].sample(*reply->position_turns, arrival_ns);
    loop.axes[at].temperature_C = *reply->temperature_C;
    axis.incomplete = 0;
    axis.torque_Nm = *reply->torque_Nm;
    limited_ += is_moteus_limit(axis.fault) ? 1 : 0;
    const bool idle =
        axis.is_in(MoteusMode::kPosition) && std::abs(axis.torque_Nm) <= max_excess_Nm_;
    axis.settled = loop.power == CanPower::kStarting && idle ? axis.settled + 1 : 0;
    axis.excess.measure(axis.torque_Nm, loop.power == CanPower::kReady);
    return true;
  }

  bool is_command(const can::CanFdFrame& frame) const RT_SAFE override {
    const int to = moteus_address(frame).destination;
    return to == kMoteusAllNodes || std::ranges::find(nodes_, to) != nodes_.end();
  }

  void update_power(Loop& loop) RT_SAFE override {
    if (loop.power == CanPower::kOff) return;  // every tick sends a stop, which clears a fault
    bool settled = true;
    // Read once: an axis that waits for power starts the loop again, and hides nothing of the next.
    const Asked before{.ns = loop.asked_ns,
                       .is_ready = loop.power == CanPower::kReady,
                       .is_late = loop.start_is_late()};
    for (std::size_t i = 0; i < 3; ++i) {
      evaluate(loop, i, before);
      settled = settled && axes_[i].settled >= kSettledTicks;
    }
    if (loop.power == CanPower::kStarting && settled) loop.become_ready();
  }

  void push(Loop& loop, const delta::Joints& torque_Nm) RT_SAFE override {
    const bool powered = loop.power != CanPower::kOff;
    if (powered && loop.asked_ns == 0) loop.asked_ns = loop.now_ns;
    const bool clears = powered && loop.asks_again();  // the fault of one without power
    for (std::size_t i = 0; i < 3; ++i) {
      axes_[i].excess.command(powered ? torque_Nm[i] : 0.0);
      const bool stops = !powered || (clears && axes_[i].has_low_supply());
      loop.bus.push(stops ? moteus_stop_and_ask(nodes_[i])
                          : moteus_torque(nodes_[i], torque_Nm[i], kWatchdog_s));
    }
  }

  void push_fault(Loop& loop) RT_SAFE override { push_stops(loop); }

  bool push_stop(Loop& loop, int step) override {
    push_stops(loop);  // no torque and no power in one; the second is for a frame that was lost
    return step < 1;
  }

  std::string text_of(const FaultCause& cause) const override {
    switch (static_cast<MoteusCause>(cause.kind)) {
      case MoteusCause::kFault:
      case MoteusCause::kLowSupply:
        return moteus_fault_message(static_cast<int>(cause.code));
      case MoteusCause::kTimeout:
        return fmt::format(
            "its watchdog expired, no command reached it for {:.0f} ms: check the CAN cable, and "
            "that tactd runs in real time",
            1e3 * kWatchdog_s);
      case MoteusCause::kLeftPosition:
        return fmt::format(
            "the drive left position mode by itself and is {}: is there a second controller or a "
            "second drive with this node id on the bus?",
            moteus_mode_name(static_cast<int>(cause.code)));
      case MoteusCause::kNotStarted:
        return fmt::format(
            "the drive does not enter position mode and is {}: calibrate it with moteus_tool, and "
            "check its supply",
            moteus_mode_name(static_cast<int>(cause.code)));
      case MoteusCause::kExcessTorque:
        return fmt::format(
            "the drive gives {:.2f} N m that was not commanded: set servo.pid_position.ki and "
            "ilimit to 0, and calibrate it with moteus_tool",
            1e-3 * static_cast<std::int32_t>(cause.code));
      case MoteusCause::kIncomplete:
        return "its replies lack what was asked for: is another device at this id, or another "
               "firmware in it?";
    }
    return {};
  }

  std::vector<DeviceCount> counters() const override {
    return {{"old", old_}, {"extra", extra_}, {"incomplete", incomplete_}, {"limited", limited_}};
  }

 private:
  struct Axis {
    int mode = 0, fault = 0;   // of the last reply
    double torque_Nm = 0.0;    // measured
    can::ExcessTorque excess;  // an integral term winds up towards position 0
    int settled = 0;           // replies in a row, while starting
    int incomplete = 0;        // the same, of those that are not whole
    bool is_in(MoteusMode one) const RT_SAFE { return mode == static_cast<int>(one); }
    bool has_low_supply() const RT_SAFE {
      return is_in(MoteusMode::kFault) && fault == kLowSupplyFault;
    }
  };

  /// Of the loop, when a tick's evaluation begins.
  struct Asked {
    std::int64_t ns;
    bool is_ready, is_late;
  };

  /// One drive that shall have power.
  void evaluate(Loop& loop, std::size_t i, const Asked& before) const RT_SAFE {
    const Axis& axis = axes_[i];
    const auto mode = static_cast<std::uint32_t>(axis.mode);
    // The first reply after a stop may still hold the state before it.
    const bool asked = before.ns != 0 && loop.axes[i].heartbeat_ns > before.ns;
    if (asked && axis.has_low_supply() && !loop.has_shown_force)
      return loop.wait_for_power(i, MoteusCause::kLowSupply, kLowSupplyFault);
    if (asked && axis.is_in(MoteusMode::kFault))
      loop.fail(i, MoteusCause::kFault, static_cast<std::uint32_t>(axis.fault));
    if (asked && axis.is_in(MoteusMode::kTimeout)) loop.fail(i, MoteusCause::kTimeout, 0);
    if (before.is_ready && !axis.is_in(MoteusMode::kPosition))
      loop.fail(i, MoteusCause::kLeftPosition, mode);
    if (axis.excess.exceeds(max_excess_Nm_)) return fail_excess(loop, i, axis.excess.mean_Nm());
    if (!before.is_late || axis.settled >= kSettledTicks) return;
    if (!axis.is_in(MoteusMode::kPosition)) return loop.fail(i, MoteusCause::kNotStarted, mode);
    fail_excess(loop, i, axis.torque_Nm);
  }

  static void fail_excess(Loop& loop, std::size_t i, double torque_Nm) RT_SAFE {
    const auto torque_mNm = static_cast<std::int32_t>(std::clamp(1e3 * torque_Nm, -1e6, 1e6));
    loop.fail(i, MoteusCause::kExcessTorque, static_cast<std::uint32_t>(torque_mNm));
  }

  void push_stops(Loop& loop) const RT_SAFE {
    for (const int node : nodes_) loop.bus.push(moteus_stop(node));
  }

  std::array<int, 3> nodes_;
  double max_excess_Nm_;
  std::array<Axis, 3> axes_{};
  std::uint64_t old_ = 0;         // replies from before the last read
  std::uint64_t extra_ = 0;       // a second reply of a drive in one tick: the newer one is taken
  std::uint64_t incomplete_ = 0;  // replies that lack what was asked for
  std::uint64_t limited_ = 0;     // replies that report a limit that cuts the torque
};

}  // namespace

Result<std::unique_ptr<Device>> start_moteus_delta(std::unique_ptr<can::CanFdBus> bus,
                                                   const model::DeviceSettings& settings,
                                                   double rate_Hz) {
  if (!(rate_Hz >= kMinRate_Hz)) {
    return Error{
        fmt::format("rate_Hz is {}, but a moteus' torque is valid for {:.0f} ms: use {} or "
                    "more",
                    rate_Hz, 1e3 * kWatchdog_s, kMinRate_Hz)};
  }
  const auto& can = settings.of<can::CanSettings>();
  const auto& delta = settings.of<can::DeltaSettings>();
  auto start = bring_up_moteus(*bus, can);
  if (!start) return start.error();
  // A reply holds the state before its command (MO-2), so a position is one period old when it
  // is used; then all frames of a tick on the bus, at most.
  const auto period_ns = static_cast<double>(model::period_ns(rate_Hz));
  const double bus_s = can::bus_time_s(moteus_cycle_bits(can), bus->rate());
  return can::start_can_device(
      std::move(bus), settings, rate_Hz,
      {.drives = std::make_unique<Moteuses>(can, delta.max_joint_torque_Nm / delta.gear_ratio),
       .name = "delta with three moteus on CAN FD",
       .position = "reply",
       .one_sync = true,
       .most_silent_ns = kSilence_ns,
       .counts_per_turn = delta.counts_per_turn,
       .delay_s = 1e-9 * period_ns + bus_s,
       .motor_turns = start->motor_turns,
       .caution = start->caution});
}

Result<std::unique_ptr<Device>> open_can_moteus(const model::DeviceSettings& settings,
                                                double rate_Hz) {
  const can::CanSettings& can = settings.of<can::CanSettings>();
  if (auto error = can::lock_drives(can, /*gives_sync=*/false)) return *error;
  auto socket =
      can::open_checked_can(can.interface, moteus_cycle_bits(can), rate_Hz, moteus_ids(can),
                            std::array{can.node[0], can.node[1], can.node[2], kMoteusAllNodes});
  if (!socket) return socket.error();
  return start_moteus_delta(std::make_unique<can::CanFdBus>(std::move(*socket)), settings, rate_Hz);
}

}  // namespace tact::hal::moteus
