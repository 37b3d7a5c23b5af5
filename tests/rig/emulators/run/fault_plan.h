// SPDX-License-Identifier: Apache-2.0
// fault_plan.h - which fault an emulator commits when, and what the other side then did.
//
//     --fault KIND[:NUMBER]@SECONDS[+DURATION_MS]
//
// NUMBER is the axis 1..3 (none: all), of no-reply the milliseconds. SECONDS count from the moment
// the device is first enabled (drives in closed loop, grip homed), or with --clock start from the
// start of the program. A row of the answer says when the torques became zero and whether anything
// moved again.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tact::rig {

enum class FaultKind : std::uint8_t {
  kLost,
  kDuplicated,
  kReordered,
  kStale,
  kWrongNode,
  kDriveFault,
  kEmcy,
  kHeartbeatMissing,
  kSilent,
  kGarbage,
  kBusOffFrame,
  kErrorPassiveFrame,
  kNoAckFrame,
  kUnpowered,
  kUnplug,
  kStall,
  kShort,
  kNoReply,
  kDuplicate,
};
enum class FaultSide : std::uint8_t { kDrives = 1, kFalcon = 2, kBoth = 3 };

struct Fault {
  FaultKind kind{};
  std::string text;        // as it was ordered
  int axis = -1;           // 0..2; -1: all
  std::int64_t at_ns = 0;  // after the clock of the faults starts
  std::int64_t duration_ns = 0;
  std::int64_t injected_ns = 0;             // CLOCK_MONOTONIC; 0: not yet
  std::int64_t last_force_ns = 0;           // of the last command of more than 0.05 N after it
  std::int64_t torque_zero_ns = 0;          // when no motor had any torque, the first time
  std::int64_t force_zero_ns = 0;           // when the hand first got less than 0.05 N
  double largest_after_zero_N = 0.0;        // at the hand, since torque_zero_ns
  double largest_after_force_zero_N = 0.0;  // ... since force_zero_ns
  int watchdog_trips = 0;
  mutable int acts = 0;        // how often it changed something
  std::array<bool, 3> seen{};  // for what happens once per axis
};

/// One order; else the message with the remedy in `error`.
bool parse_fault(std::string_view text, FaultSide side, Fault& fault, std::string& error);
/// The kinds of one program, for its --help.
std::string fault_names(FaultSide side);

class FaultPlan {
 public:
  FaultPlan() = default;
  explicit FaultPlan(std::vector<Fault> faults) : faults_(std::move(faults)) {}

  /// The faults' clock starts now; again: nothing.
  void start(std::int64_t now_ns);
  bool has_started() const { return start_ns_ != 0; }
  /// Stamp what is due.
  void tick(std::int64_t now_ns);
  /// Whether a fault of this kind acts on this axis now.
  bool active(FaultKind kind, int axis, std::int64_t now_ns) const;
  /// True once per fault and axis, when it is due.
  bool once(FaultKind kind, int axis, std::int64_t now_ns);
  /// What the motors do, after every command and every millisecond.
  void watch(double force_N, bool torque_is_zero, std::int64_t now_ns);
  void watchdog_tripped();

  const std::vector<Fault>& faults() const { return faults_; }

 private:
  bool is_on(const Fault& fault, FaultKind kind, int axis, std::int64_t now_ns) const;

  std::vector<Fault> faults_;
  std::int64_t start_ns_ = 0;
};

}  // namespace tact::rig
