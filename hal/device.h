// SPDX-License-Identifier: Apache-2.0
// device.h - one interface for every haptic device, simulated or real.
//
// Only frame W leaves a device (types.h). What can be found out before the loop is found out while
// opening, with a message; drives are powered by the loop alone, so that none is ever without
// commands (one that must be on to tell where it is gets zero torque all the while). A fault of the
// device stays until it is opened again: a bus that comes back by itself moves nothing.
#pragma once

#include <cstdint>
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

/// One reading. A device that has nothing new leaves `fresh` false and the rest untouched.
struct Sample {
  Tool tool;
  double grip_gap_m = 0.0;      // between the fingers, where the device can press against them
  double grip_speed_mps = 0.0;  // of the gap, opening positive
  std::int64_t stamp_ns = 0;    // CLOCK_MONOTONIC when the device state was taken
  std::uint64_t sequence = 0;   // counts device samples, never repeats
  bool fresh = false;
};

/// How the hand tells the device to close the jaws of the tool.
enum class GripKind : std::uint8_t {
  kNone,    // it has nothing for it: device.lines.grip may stand in
  kButton,  // open or closed
  kAngle,   // a gripper that tells how far it is closed
  kForce,   // the same, and its motor can press against the fingers
};

/// Without a default: each back end says it.
struct DeviceGrip {
  // NOLINTNEXTLINE(google-explicit-constructor)
  constexpr DeviceGrip(GripKind of, double most_N = 0.0) : kind(of), max_force_N(most_N) {}
  GripKind kind;
  double max_force_N;  // that it can press against the fingers; 0: none
};

/// What the hardware can do; the gate takes the smaller of this and the scene.
struct DeviceInfo {
  std::string name;
  double max_force_N = 0.0;
  double max_torque_Nm = 0.0;           // 0: the device has no torque
  double max_continuous_force_N = 0.0;  // largest RMS that its motors bear; 0: not told
  double workspace_radius_m = 0.0;      // cylinder about the W x axis, centred on the origin of W
  double workspace_half_length_m = 0.0;
  DeviceGrip grip;
  bool turns_with_base = false;  // it senses how its handle is turned, from its base
  double motion_scale = 1.0;     // way of the tool for a way of the handle (mounting.h)
  /// What bounds the stiffness it can show; a device without it is never felt.
  std::optional<model::DeviceAtTool> at_tool{};
  std::string damping_key{};  // of the scene, where the damping was entered; empty: nowhere
  std::string caution{};      // what its own settings may do to a force, with numbers; or empty
};

/// Something that a device counted, for the report.
struct DeviceCount {
  const char* name;
  std::uint64_t count;
};

/// An open device makes no force before the first write. Its destructor zeroes the force and
/// powers off, as stop() does.
class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  // Set-up, before the loop.

  virtual DeviceInfo info() const = 0;

  /// System calls that read, permit and write make, by number (sys/syscall.h). The loop's thread
  /// may make no other: one that is missing here stops the force.
  virtual std::span<const int> loop_calls() const { return {}; }

  /// What takes the force away after this process has died. None for a
  /// simulated device, and for one whose handle no other process can use.
  virtual std::optional<ShutdownFrames> shutdown_frames() { return std::nullopt; }

  // The loop's thread, once a tick and in this order.

  /// Newest sample; none is fresh until the device knows where it is. Fault::kNone, or what is
  /// wrong with the device.
  [[nodiscard]] virtual Fault read(Sample& sample, std::int64_t now_ns) RT_SAFE = 0;

  /// Would a force of this tick reach the hand? A device whose motors are off may still tell where
  /// it is, with fresh samples: nothing is armed before this is true, and what is armed stops when
  /// it no longer is.
  virtual bool ready() const RT_SAFE { return true; }

  /// May the drives have power in this tick? Safety lines decide; without lines always true.
  virtual void permit(bool powered) RT_SAFE { (void)powered; }

  /// Hand this wrench to the hardware, on top of its own gravity compensation.
  [[nodiscard]] virtual Fault write(const Wrench& wrench) RT_SAFE = 0;

  /// What the gripper does to the fingers, opening positive; holds from the next write on.
  virtual void set_grip_force(double opening_N) RT_SAFE { (void)opening_N; }

  /// How far a clutch has moved the tool from the handle, in W, when it may have changed. For a
  /// simulated hand, which is told where its tool shall go.
  virtual void shift_tool(const Vec3& shift_m) RT_SAFE { (void)shift_m; }

  /// What happens to a simulated device while the loop sleeps: one or more periods of physics.
  /// Hardware lives by itself and does nothing here. Not part of the tick's measured time.
  virtual void between_ticks(double elapsed_s) RT_SAFE { (void)elapsed_s; }

  // Any thread, at any time.

  /// What lies behind the latched fault, for a person: which part, why, the remedy. Empty when
  /// there is no more to say than the fault's own words.
  virtual std::string trouble() const { return {}; }

  // When the loop has ended.

  /// What it counted since it was opened, as frames that are nobody's.
  virtual std::vector<DeviceCount> counters() const { return {}; }

  /// Zero force and power off; may block. Safe to call twice, and at any time after opening.
  virtual void stop() = 0;

  /// What stop() could not switch off, with the remedy; empty: all is off.
  virtual std::string why_not_off() const { return {}; }
};

}  // namespace tact::hal
