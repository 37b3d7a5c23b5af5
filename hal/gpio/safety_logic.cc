// SPDX-License-Identifier: Apache-2.0
#include "hal/gpio/safety_logic.h"

#include <array>
#include <cstddef>

namespace tact::hal::gpio {

using model::Fault;

const char* text_of(LinesCause cause) {
  static constexpr std::array kWords{
      // in the order of LinesCause
      "",
      "the clutch line changes faster than a foot can press, and counts as pressed: a wire "
      "has a bad contact or the switch is broken; repair it (device.lines.clutch), then it counts "
      "again after a second",
      "the grip line changes faster than a foot can press: a wire has a bad contact or the switch "
      "is broken; repair it (device.lines.grip), then reset and arm",
      "the dead-man switch is open; hold it, then reset and arm",
      "one channel of the e-stop opened for a moment: it was pressed briefly, or a wire is "
      "loose; check device.lines.estop_a and estop_b, then reset and arm",
      "both channels of the e-stop are open: it is pressed, or has no supply; release it, "
      "then reset and arm",
      "channel A of the e-stop stays open while channel B is closed: repair the wire or the "
      "contact of A, press and release the e-stop, then reset and arm",
      "channel B of the e-stop stays open while channel A is closed: repair the wire or the "
      "contact of B, press and release the e-stop, then reset and arm",
      "channel A of the e-stop did not open with channel B: A is welded or shorted, or a "
      "wire of B broke; repair it, press and release the e-stop, then reset and arm",
      "channel B of the e-stop did not open with channel A: B is welded or shorted, or a "
      "wire of A broke; repair it, press and release the e-stop, then reset and arm",
      "the GPIO chip of device.lines does not answer any more: check it and its driver "
      "(gpiodetect lists the chips), then start tactd again",
  };
  static_assert(kWords.size() == static_cast<std::size_t>(LinesCause::kChipLost) + 1);
  return kWords[static_cast<std::size_t>(cause)];
}

void SafetyLogic::compare(const SafetyLevels& levels) RT_SAFE {
  if (levels.estop_a == levels.estop_b) {
    differing_ = false;
    agreed_closed_ = levels.estop_a;
    // Both open together: each contact has shown that it can move.
    if (!levels.estop_a) unproven_ = false;
    return;
  }
  if (!differing_) differ_since_ns_ = now_ns_;
  differing_ = true;
  // The contacts of one button do not open at the same instant (GP-1).
  if (now_ns_ - differ_since_ns_ <= kDiscrepancy_ns) return;
  unproven_ = true;
  // The channel that has not moved since they agreed is the one to look at.
  const bool a_moved = levels.estop_a != agreed_closed_;
  if (agreed_closed_)
    stuck_ = a_moved ? LinesCause::kBStaysClosed : LinesCause::kAStaysClosed;
  else
    stuck_ = a_moved ? LinesCause::kBStaysOpen : LinesCause::kAStaysOpen;
}

Fault SafetyLogic::evaluate(const SafetyLevels& levels, std::int64_t now_ns) RT_SAFE {
  now_ns_ = now_ns;
  LinesCause cause = LinesCause::kNone;
  const bool stood = fault_ != Fault::kNone;
  fault_ = Fault::kNone;
  // From the least to the most urgent: what comes below takes the place of what is above.
  if (wiring_.grip) {
    grip_.step(levels.grip, now_ns);
    if (grip_.flaps()) {
      fault_ = Fault::kGripFlaps;
      cause = LinesCause::kGripFlaps;
    }
  }
  if (wiring_.clutch) {
    clutch_.step(levels.clutch, now_ns);
    clutch_flaps_.store(clutch_.flaps(), std::memory_order_relaxed);
  }
  if (wiring_.dead_man && !levels.dead_man) {
    fault_ = Fault::kDeadManReleased;
    cause = LinesCause::kDeadManOpen;
  }
  if (wiring_.estop) {
    compare(levels);
    if (unproven_) {
      fault_ = Fault::kLinesDiffer;
      cause = stuck_;
    } else if (!levels.estop_a || !levels.estop_b) {
      fault_ = Fault::kEmergencyStop;
      cause = levels.estop_a == levels.estop_b ? LinesCause::kBothOpen : LinesCause::kOneOpen;
    }
  }
  // A new fault starts with its own cause; a standing one only learns more (order of LinesCause).
  if (fault_ != Fault::kNone && (!stood || cause > this->cause()))
    // Relaxed: one byte for a message; the fault itself goes by the loop.
    cause_.store(cause, std::memory_order_relaxed);
  return fault_;
}

SafetyOutputs SafetyLogic::drive(const LinesTick& tick) RT_SAFE {
  const bool good = fault_ == Fault::kNone && !tick.faulted;
  // A heartbeat that paused starts its 100 ms again: the relay beside it has dropped.
  if (!good || now_ns_ - last_toggle_ns_ > kHeartbeatPause_ns) beating_ = false;
  if (good && tick.healthy) {
    outputs_.heartbeat = !outputs_.heartbeat;
    last_toggle_ns_ = now_ns_;
    if (!beating_) heartbeat_since_ns_ = now_ns_;
    beating_ = true;
  }
  outputs_.enable = beating_ && now_ns_ - heartbeat_since_ns_ >= kHeartbeatBeforeEnable_ns;
  outputs_.led = tick.armed;
  return outputs_;
}

}  // namespace tact::hal::gpio
