// SPDX-License-Identifier: Apache-2.0
// safety_logic.h - what the levels of the safety lines mean, and what the outputs answer. Pure.
//
//   e-stop, two normally closed channels:  high = closed = good; low = open, broken wire, no power
//   one channel open                       -> kEmergencyStop, at once
//   channels differ for more than 50 ms    -> kLinesDiffer, until both have been open together:
//                                             only then a contact that sticks is repaired
//   dead-man low                           -> kDeadManReleased, at once
//   grip switch flaps (grip_switch.h)      -> kGripFlaps, until it has been quiet for a second
//   clutch      counts after 10 ms, as the grip switch; one that flaps counts as pressed: no force,
//               and no fault, until it has been quiet for a second
//   heartbeat   toggles after every healthy tick; the external relay opens 10 ms after an edge
//   enable      set 100 ms after the heartbeat has begun; cleared in the tick of a fault, or if the
//               heartbeat pauses for more than 10 ms: lines need well over 100 ticks a second
//
// The supervisor latches a fault until the operator resets it; here it lasts as long as its cause.
// Two channels that monitor each other: ISO 13850, ISO 13849-1 category 3 (GP-1).
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "hal/gpio/grip_switch.h"
#include "hal/safety_lines.h"

namespace tact::hal::gpio {

inline constexpr std::int64_t kDiscrepancy_ns = 50'000'000;
inline constexpr std::int64_t kHeartbeatBeforeEnable_ns = 100'000'000;
inline constexpr std::int64_t kHeartbeatPause_ns = 10'000'000;

/// Which inputs exist; what is not wired is good.
struct SafetyWiring {
  bool estop = false;  // both channels
  bool dead_man = false;
  bool grip = false;
  bool clutch = false;
};

struct SafetyLevels {
  bool estop_a = false, estop_b = false, dead_man = false;
  bool grip = false;  // pressed, whichever level that is
  bool clutch = false;
};

struct SafetyOutputs {
  bool enable = false, heartbeat = false, led = false;
};

/// Why the lines stop the force. Ascending: the more specific cause replaces the one before.
enum class LinesCause : std::uint8_t {
  kNone,
  kClutchFlaps,  // no fault
  kGripFlaps,
  kDeadManOpen,
  kOneOpen,  // for now: a channel of a good switch opens a little before the other
  kBothOpen,
  kAStaysOpen,    // both were open, B has closed: wire or contact of A
  kBStaysOpen,    // the same the other way round
  kAStaysClosed,  // both were closed, B has opened: A is welded or shorted, or B's wire broke
  kBStaysClosed,
  kChipLost,
};

/// One message for a person; empty for kNone.
const char* text_of(LinesCause cause);

class SafetyLogic {
 public:
  explicit SafetyLogic(const SafetyWiring& wiring) : wiring_(wiring) {}

  /// Levels of this tick. kNone, or the present fault.
  model::Fault evaluate(const SafetyLevels& levels, std::int64_t now_ns) RT_SAFE;
  /// Outputs of this tick, after evaluate().
  SafetyOutputs drive(const LinesTick& tick) RT_SAFE;

  /// The grip of the last evaluate(); nothing where none is wired.
  std::optional<bool> grip() const RT_SAFE {
    return wiring_.grip ? std::optional(grip_.pressed()) : std::nullopt;
  }
  std::optional<bool> clutch() const RT_SAFE {
    return wiring_.clutch ? std::optional(clutch_.pressed() || clutch_.flaps()) : std::nullopt;
  }
  /// One message for a person while the clutch flaps, else empty. Any thread.
  const char* notice() const {
    return text_of(clutch_flaps_.load(std::memory_order_relaxed) ? LinesCause::kClutchFlaps
                                                                 : LinesCause::kNone);
  }
  bool enabled() const RT_SAFE { return outputs_.enable && fault_ == model::Fault::kNone; }
  /// The most specific cause of the present fault, or of the last one. Any thread.
  LinesCause cause() const RT_SAFE { return cause_.load(std::memory_order_relaxed); }

 private:
  void compare(const SafetyLevels& levels) RT_SAFE;

  SafetyWiring wiring_;
  model::Fault fault_ = model::Fault::kNone;
  std::atomic<LinesCause> cause_{LinesCause::kNone};
  std::atomic<bool> clutch_flaps_{false};
  GripSwitch grip_, clutch_;
  SafetyOutputs outputs_;
  std::int64_t now_ns_ = 0;
  std::int64_t differ_since_ns_ = 0;
  std::int64_t heartbeat_since_ns_ = 0, last_toggle_ns_ = 0;
  bool agreed_closed_ = false;  // what the channels last agreed on
  bool differing_ = false;
  bool unproven_ = false;  // they differed for too long and have not been open together since
  LinesCause stuck_ = LinesCause::kNone;
  bool beating_ = false;
};

}  // namespace tact::hal::gpio
