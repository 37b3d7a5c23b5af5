// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/cia402_delta.h"

#include <algorithm>
#include <array>
#include <utility>

#include "hal/can/can_device.h"
#include "hal/can/can_open.h"
#include "hal/can/excess_torque.h"
#include "hal/cia402/canopen_frames.h"
#include "hal/cia402/cia402_bring_up.h"
#include "hal/cia402/cia402_state.h"
#include "hal/cia402/heartbeat_guard.h"
#include "model/limits.h"
#include "model/time_ns.h"

namespace tact::hal::cia402 {
namespace {

using can::CanLoop;
using can::CanPower;
using model::Result;

// Four in the 20 ms that a drive waits (CstConfiguration): one may be lost.
constexpr double kHostHeartbeat_Hz = 200.0;
constexpr int kMaxIdleTicks = model::kLostAfterSamples;  // 20 ms at 1 kHz

class Cia402s final : public can::CanDrives {
 public:
  Cia402s(const model::DeviceSettings& settings, double rate_Hz, const Cia402Start& start)
      : configuration_(cst_settings(settings.of<Cia402Settings>(), rate_Hz)),
        counts_per_motor_turn_(settings.of<Cia402Settings>().counts_per_motor_turn),
        command_at_sync_(settings.of<Cia402Settings>().command_at_sync),
        ticks_per_heartbeat_(rate_Hz > kHostHeartbeat_Hz
                                 ? static_cast<std::uint64_t>(rate_Hz / kHostHeartbeat_Hz)
                                 : 1) {
    const auto& delta = settings.of<can::DeltaSettings>();
    max_excess_Nm_ = can::kMaxExcess_ratio * delta.max_joint_torque_Nm / delta.gear_ratio;
    for (std::size_t i = 0; i < 3; ++i) {
      axes_[i].node = settings.of<can::CanSettings>().node[i];
      axes_[i].rated_torque_Nm = start.rated_torque_Nm[i];
    }
  }

  int node_of(const can::CanFrame& frame) const RT_SAFE override {
    return static_cast<int>(frame.id & 0x7Fu);
  }

  bool take(CanLoop& loop, std::size_t at, const can::CanFrame& frame,
            std::int64_t arrival_ns) RT_SAFE override {
    const int node = axes_[at].node;
    if (const auto sample = decode_cst_sample(frame, node)) {
      take_sample(loop, at, *sample, arrival_ns);
    } else if (const auto state = decode_canopen_heartbeat(frame, node)) {
      if (loop.axes[at].beat(arrival_ns) && *state != NmtState::kOperational)
        loop.fail(at, Cia402Cause::kLeftOperational, static_cast<std::uint32_t>(*state));
    } else if (const auto emergency = decode_canopen_emergency(frame, node)) {
      if (emergency->code != 0)  // "errors are gone": what latched stays
        take_emergency(loop, at, emergency->code);
    } else if (const auto reply = decode_canopen_sdo(frame, node)) {
      axes_[at].guard.take(*reply);
    } else {
      return false;
    }
    return true;
  }

  bool is_command(const can::CanFrame& frame) const RT_SAFE override {
    const auto is = [&frame](std::uint32_t id) RT_SAFE { return frame.id == id; };
    if (frame.rtr) return false;
    if (is(host_heartbeat_id(configuration_)) || std::ranges::any_of(kCanopenForAll, is))
      return true;
    return std::ranges::any_of(axes_, [&](const Axis& axis) RT_SAFE {
      return std::ranges::any_of(kCanopenToNode, [&](std::uint32_t base) RT_SAFE {
        return is(base + static_cast<std::uint32_t>(axis.node));
      });
    });
  }

  void update_power(CanLoop& loop) RT_SAFE override {
    if (loop.power == CanPower::kStarting && all_enabled(loop)) loop.become_ready();
    // Read once: an axis that waits for power starts the loop again, and hides nothing of the next.
    const bool lost = loop.power == CanPower::kReady, late = loop.start_is_late();
    for (std::size_t i = 0; i < 3; ++i) {
      const Axis& axis = axes_[i];
      if (lost && axis.idle_ticks >= kMaxIdleTicks) loop.fail(i, Cia402Cause::kNotFollowing, 0);
      if (axis.excess.exceeds(max_excess_Nm_)) fail_excess(loop, i);
      if (axis.state == Cia402State::kOperationEnabled) continue;
      const auto state = static_cast<std::uint32_t>(axis.state);
      if (!lost && !late) continue;
      if (!lost && !axis.guard.on()) loop.fail(i, Cia402Cause::kUnguarded, state);
      // Before any force reached the hand the drive is asked again until it has power.
      if (loop.has_shown_force)
        loop.fail(i, lost ? Cia402Cause::kLeftEnabled : Cia402Cause::kNotStarted, state);
      else
        loop.wait_for_power(i, Cia402Cause::kWaits, axis.statusword);
    }
  }

  void push(CanLoop& loop, const delta::Joints& torque_Nm) RT_SAFE override {
    const bool powered = loop.power != CanPower::kOff;
    if (powered && loop.asked_ns == 0) loop.asked_ns = loop.now_ns;
    push_heartbeat(loop.bus);
    for (std::size_t i = 0; i < 3; ++i)
      push_command(loop.bus, axes_[i], controlword_of(loop, i), torque_Nm[i]);
    loop.bus.push(canopen_sync());
    // After SYNC, so that they delay nothing. The last write of a loop is one without permission.
    for (Axis& axis : axes_)
      if (const auto question = axis.guard.step(powered, axis.node, configuration_))
        loop.bus.push(question);
  }

  void push_fault(CanLoop& loop) RT_SAFE override {
    push_heartbeat(loop.bus);
    push_commands(loop.bus, kControlQuickStop);
    // A drive of type 1 acts on the quick stop at SYNC, not before.
    if (command_at_sync_) loop.bus.push(canopen_sync());
  }
  /// Drives without a fault of their own would note one if they heard no host.
  void push_after_fault(CanLoop& loop) RT_SAFE override { push_heartbeat(loop.bus); }

  bool push_stop(CanLoop& loop, int step) override {
    push_commands(loop.bus, step < 2 ? kControlQuickStop : kControlDisableVoltage);
    loop.bus.push(canopen_sync());
    return step < 2;
  }
  void push_leave(CanLoop& loop) override {
    for (const Axis& axis : axes_) {
      // First, as some drives refuse to end their watch while operational (heartbeat_guard.h).
      loop.bus.push(canopen_nmt(NmtCommand::kPreOperational, axis.node));
      // The host's heartbeat is no longer sent: that is no fault now.
      loop.bus.push(canopen_sdo_download(
          axis.node,
          {.index = 0x1016, .sub = 1, .value = host_watch(configuration_, 0), .size = 4}));
    }
  }

  std::string text_of(const FaultCause& cause) const override {
    return text_of_cia402_cause(cause);
  }

  std::vector<DeviceCount> counters() const override { return {{"old", old_}, {"extra", extra_}}; }

 private:
  struct Axis {
    int node = 0;
    double rated_torque_Nm = 0.0;
    Cia402State state = Cia402State::kUnknown;
    std::uint16_t statusword = 0;
    std::uint16_t controlword = kControlDisableVoltage;  // sent last
    int idle_ticks = 0;  // enabled without following, in a row, since ready
    can::ExcessTorque excess;
    HeartbeatGuard guard;
  };

  void take_sample(CanLoop& loop, std::size_t at, const CstSample& sample,
                   std::int64_t arrival_ns) RT_SAFE {
    if (arrival_ns < loop.before_ns) {  // of an older SYNC: it lay in a queue
      ++old_;
      return;
    }
    extra_ += loop.axes[at].sampled ? 1 : 0;
    loop.axes[at].replies.add_reply();
    loop.axes[at].sample(sample.position_increments / counts_per_motor_turn_, arrival_ns);
    Axis& axis = axes_[at];
    axis.statusword = sample.statusword;
    axis.state = cia402_state(sample.statusword);
    const bool idle = loop.power == CanPower::kReady &&
                      axis.state == Cia402State::kOperationEnabled &&
                      !cia402_flags(sample.statusword).following;
    axis.idle_ticks = idle ? axis.idle_ticks + 1 : 0;
    axis.excess.measure(1e-3 * sample.torque_permille * axis.rated_torque_Nm,
                        loop.power == CanPower::kReady);
    if (axis.state == Cia402State::kFault || axis.state == Cia402State::kFaultReaction)
      loop.fail(at, Cia402Cause::kStatus, static_cast<std::uint32_t>(axis.state));
  }

  void fail_excess(CanLoop& loop, std::size_t at) const RT_SAFE {
    const double excess_mNm = std::clamp(1e3 * axes_[at].excess.mean_Nm(), -1e6, 1e6);
    loop.fail(at, Cia402Cause::kExcessTorque,
              static_cast<std::uint32_t>(static_cast<std::int32_t>(excess_mNm)));
  }

  /// The state may have come first, without a reason.
  void take_emergency(CanLoop& loop, std::size_t at, std::uint16_t code) RT_SAFE {
    const auto kind = static_cast<std::uint8_t>(Cia402Cause::kEmergency);
    // The code says more than the state: it takes the place of a cause without a reason.
    if (loop.latch.cause().kind == static_cast<std::uint8_t>(Cia402Cause::kStatus)) {
      loop.latch.explain({.fault = Fault::kDriveFault,
                          .axis = static_cast<std::uint8_t>(at),
                          .kind = kind,
                          .code = code});
    }
    loop.fail(at, Cia402Cause::kEmergency, code);
  }

  bool all_enabled(const CanLoop& loop) const RT_SAFE {
    for (std::size_t i = 0; i < 3; ++i)
      if (!loop.axes[i].sampled || axes_[i].state != Cia402State::kOperationEnabled) return false;
    return true;
  }

  /// One step per statusword; a drive that said nothing in this tick hears the same again.
  std::uint16_t controlword_of(const CanLoop& loop, std::size_t at) const RT_SAFE {
    const Axis& axis = axes_[at];
    // No power without the drive's own watch: if tactd died, nothing would take the torque away.
    if (loop.power == CanPower::kOff || !axis.guard.on()) return kControlDisableVoltage;
    if (!loop.axes[at].sampled) return axis.controlword;
    const auto next = next_controlword(axis.state, axis.controlword);
    // A fault has latched before it comes to that; nothing here may reset it.
    return next && *next != kControlFaultReset ? *next : axis.controlword;
  }

  void push_heartbeat(can::CanBus& bus) RT_SAFE {
    if (ticks_++ % ticks_per_heartbeat_ == 0)
      bus.push(canopen_heartbeat(configuration_.host_node, NmtState::kOperational));
  }
  void push_command(can::CanBus& bus, Axis& axis, std::uint16_t controlword,
                    double torque_Nm) RT_SAFE {
    axis.controlword = controlword;
    axis.excess.command(torque_Nm);
    const auto permille = cst_torque_permille(torque_Nm, axis.rated_torque_Nm);
    // Nothing to push makes the batch a missed cycle (can_bus.h): the bus then counts it.
    bus.push(permille ? cst_command(axis.node, controlword, *permille) : std::nullopt);
  }
  void push_commands(can::CanBus& bus, std::uint16_t controlword) RT_SAFE {
    for (Axis& axis : axes_) push_command(bus, axis, controlword, 0.0);
  }

  CstConfiguration configuration_;
  double counts_per_motor_turn_;
  bool command_at_sync_;
  std::uint64_t ticks_per_heartbeat_;
  std::array<Axis, 3> axes_;
  double max_excess_Nm_ = 0.0;
  std::uint64_t ticks_ = 0;
  std::uint64_t extra_ = 0;  // a second sample of a drive in one tick: the newer one is taken
  std::uint64_t old_ = 0;    // samples from before the last read
};

}  // namespace

Result<std::unique_ptr<Device>> start_cia402_delta(std::unique_ptr<can::CanBus> bus,
                                                   const model::DeviceSettings& settings,
                                                   double rate_Hz) {
  const auto& own = settings.of<Cia402Settings>();
  const auto start = bring_up_cia402(*bus, settings, rate_Hz);
  if (!start) return start.error();
  // A sample is one period old when it is used; then three commands on the bus, and a period more
  // if they wait for SYNC.
  const auto period_ns = model::period_ns(rate_Hz);
  const int periods = own.command_at_sync ? 2 : 1;
  const double bus_s = can::bus_time_s(3 * can::most_can_bits(4), bus->rate());
  return can::start_can_device(
      std::move(bus), settings, rate_Hz,
      {.drives = std::make_unique<Cia402s>(settings, rate_Hz, *start),
       .name = "delta with three CiA 402 drives on CAN",
       .position = "position",
       .one_sync = true,
       // Three heartbeats and half of one.
       .most_silent_ns =
           model::kMillisecond_ns * cst_settings(own, rate_Hz).drive_heartbeat_ms * 7 / 2,
       .counts_per_turn = own.counts_per_motor_turn * settings.of<can::DeltaSettings>().gear_ratio,
       .delay_s = 1e-9 * static_cast<double>(periods * period_ns) + bus_s,
       .motor_turns = start->motor_turns,
       .caution = start->caution});
}

Result<std::unique_ptr<Device>> open_can_cia402(const model::DeviceSettings& settings,
                                                double rate_Hz) {
  const can::CanSettings& can = settings.of<can::CanSettings>();
  if (auto error = can::lock_drives(can, /*gives_sync=*/true)) return *error;
  auto socket = can::open_checked_can(can.interface, cia402_cycle_bits(), rate_Hz, cia402_ids(can));
  if (!socket) return socket.error();
  return start_cia402_delta(std::make_unique<can::CanBus>(std::move(*socket)), settings, rate_Hz);
}

}  // namespace tact::hal::cia402
