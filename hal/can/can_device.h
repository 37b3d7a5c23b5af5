// SPDX-License-Identifier: Apache-2.0
// can_device.h - a delta with three drives of any kind on one CAN bus, as a haptic device.
//
//     read     all frames to the drives' rules; then timeouts, sample and pose    one recvmmsg
//     write    torques of force and gravity, in these drives' own frames         one sendmmsg
//
//     off --permit--> starting --all three give torque--> ready --not permitted--> off
//     any --fault--> stopped
//
// Torque is zero unless ready. A sample is fresh, of drives that sample at one SYNC, when all three
// have sent a new position since the last read; of drives with their own clocks, when one has and
// no position is older than 1.5 periods, as a tick may get no frame of an axis and the next tick
// two. It may be fresh without power. Its stamp is the arrival of the oldest position. Without
// samples the torques ramp down (sample_gap.h). A fault stops all three and latches; only opening
// the device again clears it.
//
// A new kind of drive adds its frames, its bring-up and an implementation of CanDrives (of
// CanFdDrives for CAN FD: bus, socket and device are templates of the frame).
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "hal/can/can_bus.h"
#include "hal/can/can_delta.h"
#include "hal/can/reply_balance.h"
#include "hal/device.h"
#include "model/device_settings.h"
#include "model/result.h"
#include "model/time_ns.h"

namespace tact::hal::can {

enum class CanPower : std::uint8_t { kOff, kStarting, kReady, kStopped };

/// What the loop knows of one drive of any kind.
struct CanAxis {
  int node = 0;
  bool located = false;           // has ever reported a position
  bool sampled = false;           // since the last read
  bool jumps = false;             // its positions are not to be trusted
  double motor_turns = 0.0;       // the newest
  std::int64_t arrival_ns = 0;    // of that
  std::int64_t heartbeat_ns = 0;  // arrival of the newest one
  double temperature_C = std::numeric_limits<double>::quiet_NaN();  // of a drive that reports it
  ReplyBalance replies{};  // of drives that sample at SYNC or answer each command

  void sample(double turns, std::int64_t at_ns) RT_SAFE {
    located = sampled = true;
    motor_turns = turns;
    arrival_ns = at_ns;
  }
  /// A heartbeat; false: older than the newest, or than the first tick.
  bool beat(std::int64_t at_ns) RT_SAFE {
    if (at_ns < heartbeat_ns) return false;
    heartbeat_ns = at_ns;
    return true;
  }
};

/// Longest time from the request for torque until a drive gives it; after that the start is late.
inline constexpr std::int64_t kLongestStart_ns = 3 * model::kSecond_ns;

/// The bus and its three drives in the loop, as device and rules share them.
template <class Frame>
struct BasicCanLoop {
  BasicCanBus<Frame>& bus;
  std::array<CanAxis, 3> axes{};
  CanPower power = CanPower::kOff;
  std::int64_t now_ns = 0;       // of the last read; 0: none yet
  std::int64_t before_ns = 0;    // of the read before
  std::int64_t first_ns = 0;     // of the first one
  std::int64_t asked_ns = 0;     // for torque, since starting; 0: not yet
  bool has_shown_force = false;  // a force has reached the drives: power that goes is a fault now
  FaultLatch latch{};
  WaitNote waits{};             // for power, before that
  std::int64_t ask_again_ns{};  // for it

  /// Latches; `kind` is a CanCause, or of the drives' own list.
  template <class Kind>
  void fail(std::size_t axis, Kind kind, std::uint32_t code,
            Fault fault = Fault::kDriveFault) RT_SAFE {
    latch.set({.fault = fault,
               .axis = static_cast<std::uint8_t>(axis),
               .kind = static_cast<std::uint8_t>(kind),
               .code = code});
  }
  /// No power before the first force is no fault: starts again, and asks until there is power.
  template <class Kind>
  void wait_for_power(std::size_t axis, Kind kind, std::uint32_t code) RT_SAFE {
    if (power == CanPower::kReady) power = CanPower::kStarting;
    asked_ns = 0;
    waits.set({.axis = static_cast<std::uint8_t>(axis),
               .kind = static_cast<std::uint8_t>(kind),
               .code = code});
  }
  /// True once a second while a drive waits for power.
  bool asks_again() RT_SAFE {
    if (waits.cause().kind == 0 || now_ns < ask_again_ns) return false;
    ask_again_ns = now_ns + model::kSecond_ns;
    return true;
  }
  void become_ready() RT_SAFE {
    power = CanPower::kReady;
    waits.clear();
  }
  /// NaN if no drive reports a temperature.
  double hottest_C() const RT_SAFE {
    double out = axes[0].temperature_C;
    for (const CanAxis& axis : axes)             // bound: 3
      out = std::fmax(out, axis.temperature_C);  // leaves NaN out
    return out;
  }
  bool start_is_late() const RT_SAFE {
    return power == CanPower::kStarting && asked_ns != 0 && now_ns - asked_ns > kLongestStart_ns;
  }
};

/// The rules of one kind of drives. All but text_of(), counters() and the two of
/// the end, push_stop() and push_leave(), belong to the loop.
template <class Frame>
class BasicCanDrives {
 public:
  using Loop = BasicCanLoop<Frame>;

  BasicCanDrives() = default;
  BasicCanDrives(const BasicCanDrives&) = delete;
  BasicCanDrives& operator=(const BasicCanDrives&) = delete;
  virtual ~BasicCanDrives() = default;

  virtual int node_of(const Frame& frame) const RT_SAFE = 0;
  /// A frame of this axis: its position, its heartbeat, its faults. False: not requested.
  virtual bool take(Loop& loop, std::size_t axis, const Frame& frame,
                    std::int64_t arrival_ns) RT_SAFE = 0;
  /// A command to drives or to all nodes. Loopback is off, so it came from another sender.
  virtual bool is_command(const Frame& frame) const RT_SAFE = 0;
  /// Once all frames are taken: starting becomes ready; a drive that does not start, or lets go, is
  /// a fault.
  virtual void update_power(Loop& loop) RT_SAFE = 0;
  /// All frames of a tick, for these torques at the motors; power is off, starting or ready.
  virtual void push(Loop& loop, const delta::Joints& torque_Nm) RT_SAFE = 0;
  /// The frames that stop all three after a fault.
  virtual void push_fault(Loop& loop) RT_SAFE = 0;
  /// What goes on after those, tick by tick, so that drives without a fault note none.
  virtual void push_after_fault(Loop& loop) RT_SAFE { (void)loop; }
  /// For good: the frames of step 0, 1, ..; false: the last ones. Zero torque comes first. They are
  /// the same at any time, as another process may have to send them (hal/shutdown_frames.h).
  virtual bool push_stop(Loop& loop, int step) = 0;
  /// After those, so that drives do not miss a host that has left.
  virtual void push_leave(Loop& loop) { (void)loop; }
  /// What a cause of their own means, with the remedy. Any thread.
  virtual std::string text_of(const FaultCause& cause) const = 0;
  /// What they counted.
  virtual std::vector<DeviceCount> counters() const = 0;
};

/// Drives that are up, and notes from opening them.
template <class Frame>
struct BasicCanStart {
  std::unique_ptr<BasicCanDrives<Frame>> drives;
  std::string name;                 // of the device
  const char* position;             // what is missed when no sample comes
  bool one_sync = false;            // all three sample at one time
  std::int64_t most_silent_ns = 0;  // without a heartbeat
  double counts_per_turn = 0.0;     // of an arm
  double delay_s = 0.0;             // from position to force, beyond one hold
  delta::Joints motor_turns{};      // of arms at rest
  std::string caution{};            // DeviceInfo's
};

using CanLoop = BasicCanLoop<CanFrame>;
using CanDrives = BasicCanDrives<CanFrame>;
using CanStart = BasicCanStart<CanFrame>;
using CanFdLoop = BasicCanLoop<CanFdFrame>;
using CanFdDrives = BasicCanDrives<CanFdFrame>;
using CanFdStart = BasicCanStart<CanFdFrame>;

/// The device; an error when the arms cannot be where the drives say.
template <class Frame>
model::Result<std::unique_ptr<Device>> start_can_device(std::unique_ptr<BasicCanBus<Frame>> bus,
                                                        const model::DeviceSettings& settings,
                                                        double rate_Hz, BasicCanStart<Frame> start);

}  // namespace tact::hal::can
