// SPDX-License-Identifier: Apache-2.0
// safety_lines.h - the wires beside the device: e-stop, dead-man, grip, clutch and event word in;
// enable, heartbeat and sync out.
//
// The PC is never the safety device: the lines watch an e-stop chain that works without them, add
// one more permission in series, and prove that the loop is alive. Once per tick, in this order:
// scope(true), read, write, scope(false). Enable comes after 100 ms of heartbeat with good inputs,
// goes at the first fault before any other output, and returns only after a reset.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "model/fault.h"
#include "model/rt.h"

namespace tact::hal {

/// What the tick that ends has found.
struct LinesTick {
  bool healthy = false;  // no fault is present and the tick was in time: the heartbeat may toggle
  bool armed = false;    // for the status light
  bool faulted = false;  // a fault is present: enable goes now, not when the heartbeat is missed
  bool sync = false;     // level of the sync line
};

class SafetyLines {
 public:
  SafetyLines() = default;
  SafetyLines(const SafetyLines&) = delete;
  SafetyLines& operator=(const SafetyLines&) = delete;
  virtual ~SafetyLines() = default;

  /// Levels of now. kNone, or why force must be zero; the fault lasts while its cause does.
  [[nodiscard]] virtual model::Fault read(std::int64_t now_ns) RT_SAFE = 0;
  /// Outputs of this tick; kLinesLost when they cannot be set.
  [[nodiscard]] virtual model::Fault write(const LinesTick& tick) RT_SAFE = 0;
  /// Does the grip switch close the jaws? As of the last read; nothing where none is wired.
  virtual std::optional<bool> grip() const RT_SAFE { return std::nullopt; }
  /// Is the clutch pressed? As of the last read; nothing where none is wired.
  virtual std::optional<bool> clutch() const RT_SAFE { return std::nullopt; }
  /// Levels of the event lines as of the last read, event_0 the lowest bit; 0 where none is wired.
  virtual std::uint8_t event_word() const RT_SAFE { return 0; }
  /// May the drives have power?
  virtual bool enabled() const RT_SAFE = 0;
  /// The scope line; nothing where none is wired.
  virtual void scope(bool up) RT_SAFE = 0;
  /// Enable and heartbeat low, now and for good: for the watch above the loop, when the loop
  /// cannot. Any thread, beside any other call; again when a write of the loop may have been under
  /// way.
  virtual void drop() RT_SAFE {}
  /// System calls that the others make once per tick, by number.
  virtual std::span<const int> loop_calls() const { return {}; }
  /// What lies behind the fault of the lines, for a person: which channel, why, the remedy. Empty
  /// when there is no more to say than the fault's own words. Any thread, at any time.
  virtual std::string fault_detail() const { return {}; }
  /// What is wrong with a line without being a fault, and takes the force all the same; empty when
  /// nothing is. Any thread, at any time.
  virtual std::string notice() const { return {}; }
  /// Everything to its safe level; may block.
  virtual void stop() = 0;
};

/// Where no line is wired.
class NoSafetyLines final : public SafetyLines {
 public:
  model::Fault read(std::int64_t) RT_SAFE override { return model::Fault::kNone; }
  model::Fault write(const LinesTick&) RT_SAFE override { return model::Fault::kNone; }
  bool enabled() const RT_SAFE override { return true; }
  void scope(bool) RT_SAFE override {}
  void stop() override {}
};

}  // namespace tact::hal
