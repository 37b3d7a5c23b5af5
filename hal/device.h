// SPDX-License-Identifier: Apache-2.0
// device.h - one interface for every haptic device, simulated or real.
//
// All quantities are in frame W (types.h). Opening checks all that can be checked before the loop
// and returns an error message. Only the loop powers the drives, so a powered drive always gets
// commands (a drive that needs power to measure its position gets zero torque meanwhile). A device
// fault stays until the device is opened again, even if the bus recovers.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/shutdown_frames.h"
#include "model/device_at_tool.h"
#include "model/fault.h"
#include "model/types.h"

namespace tact::hal {

using model::Fault;
using model::Tool;
using model::Vec3;
using model::Wrench;

/// One sample. If a device has no new data, it leaves `fresh` false and all else unchanged.
struct Sample {
  Tool tool;
  double grip_gap_m = 0.0;      // between the fingers; only of a GripKind::kForce
  double grip_speed_mps = 0.0;  // of the gap, opening positive
  std::int64_t stamp_ns = 0;    // CLOCK_MONOTONIC when the device state was sampled
  std::uint64_t sequence = 0;   // counts device samples, never repeats
  bool fresh = false;
  double temperature_C = std::numeric_limits<double>::quiet_NaN();  // hottest drive; NaN: none
};

/// How the hand closes the jaws of the tool.
enum class GripKind : std::uint8_t {
  kNone,    // the device has no grip input; the line device.lines.grip can replace it
  kButton,  // open or closed
  kAngle,   // a gripper with a measured closing angle
  kForce,   // as kAngle, with a motor that presses against the fingers
};

/// No default constructor: every back end must set it.
struct DeviceGrip {
  // NOLINTNEXTLINE(google-explicit-constructor)
  constexpr DeviceGrip(GripKind of, double most_N = 0.0) : kind(of), max_force_N(most_N) {}
  GripKind kind;
  double max_force_N;  // of its motor on the fingers; 0: no motor
};

/// Limits of the hardware; the gate uses the smaller of these and the scene's (limits_for.h).
struct DeviceInfo {
  std::string name;
  double max_force_N = 0.0;
  double max_torque_Nm = 0.0;           // 0: the device has no torque
  double max_continuous_force_N = 0.0;  // largest permitted RMS of the motors; 0: not known
  double workspace_radius_m = 0.0;      // cylinder about the W x axis, centred on the origin of W
  double workspace_half_length_m = 0.0;
  DeviceGrip grip;
  bool turns_with_base = false;  // it measures the handle's orientation relative to its base
  double motion_scale = 1.0;     // displacement of the tool over that of the handle (mounting.h)
  /// Dynamics that bound the stiffness it can render; empty: the device is refused.
  std::optional<model::DeviceAtTool> at_tool{};
  std::string damping_key{};  // scene key of the damping; empty: the scene has none
  std::string caution{};      // warning: how the device's settings change a force; may be empty
};

/// A counter of the device, for the report.
struct DeviceCount {
  const char* name;
  std::uint64_t count;
};

/// An open device gives no force before the first write. The destructor does the same as stop().
///
/// Errors: opening returns a Result with a message (what, where, the value to write). In the loop
/// read and write return a Fault, which latches; fault_detail() has the part and the cause.
class Device {
 public:
  // Types: DeviceInfo, Sample and DeviceCount, above.
  // Construction: by the back end's open function (hal/registry). Not copied, not moved.

  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  // The tick: each once per period, in this order, by the loop's thread. None blocks, allocates or
  // throws. catch_up comes before the first of them.

  /// Once: reads the backlog since opening, so that the first tick is not longer. `now_ns`, as in
  /// read: CLOCK_MONOTONIC.
  virtual void catch_up(std::int64_t now_ns) RT_SAFE { (void)now_ns; }

  /// The newest sample: m, m/s, rad/s in W; not fresh until the device knows its position. Returns
  /// the device's fault, or Fault::kNone.
  [[nodiscard]] virtual Fault read(Sample& sample, std::int64_t now_ns) RT_SAFE = 0;

  /// Offset in m of the tool from the handle by the clutch, in W. Only for a simulated hand, whose
  /// target is a position of the tool. Called only with a clutch.
  virtual void shift_tool(const Vec3& shift_m) RT_SAFE { (void)shift_m; }

  /// True if the motors are on. Samples can be fresh with motors off: arming needs ready(), and
  /// the loop stops if it becomes false while armed.
  virtual bool ready() const RT_SAFE { return true; }

  /// Permission of the safety lines for power in this tick; without lines true.
  virtual void permit(bool powered) RT_SAFE { (void)powered; }

  /// Force of the gripper on the fingers in N, opening positive; applies from the next write on.
  virtual void set_grip_force(double opening_N) RT_SAFE { (void)opening_N; }

  /// Writes this wrench (N and N m, in W, on the tool) to the hardware; the device adds its gravity
  /// compensation. Returns the device's fault; kForceNotFinite for a NaN, and writes zero then.
  [[nodiscard]] virtual Fault write(const Wrench& wrench) RT_SAFE = 0;

  /// Simulates one or more periods of a simulated device; no effect on hardware. Not part of the
  /// tick's measured time.
  virtual void between_ticks(double elapsed_s) RT_SAFE { (void)elapsed_s; }

  // Outside the loop: before it.

  /// Name and limits; constant from opening on.
  virtual DeviceInfo info() const = 0;

  /// Numbers (sys/syscall.h) of all system calls in read, permit and write. Any other system call
  /// of the loop's thread latches a fault.
  virtual std::span<const int> loop_calls() const { return {}; }

  /// Frames that zero the force after this process has died. None for a simulated device, and for
  /// one whose handle another process cannot use.
  virtual std::optional<ShutdownFrames> shutdown_frames() { return std::nullopt; }

  // Outside the loop: any thread, any time.

  /// Details of the latched fault: part, cause, remedy. Empty if the fault's message says all.
  virtual std::string fault_detail() const { return {}; }

  // Outside the loop: after it.

  /// Counters since opening, such as unknown frames.
  virtual std::vector<DeviceCount> counters() const { return {}; }

  /// Sets zero force and switches power off; may block. May be called repeatedly after opening.
  virtual void stop() = 0;

  /// What stop() could not switch off, and the remedy; empty: all is off.
  virtual std::string why_not_off() const { return {}; }
};

}  // namespace tact::hal
