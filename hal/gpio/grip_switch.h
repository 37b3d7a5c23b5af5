// SPDX-License-Identifier: Apache-2.0
// grip_switch.h - is the switch on the grip line pressed? Contacts bounce, so a level counts after
// it has stood for 10 ms. Pure.
//
// A foot presses some five times a second at the most. A line flaps when it has not stood for 10 ms
// within 100 ms, or when it has changed 16 times within a second: a bad contact or a broken switch.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "model/rt.h"

namespace tact::hal::gpio {

inline constexpr std::int64_t kGripDebounce_ns = 10'000'000;
inline constexpr std::int64_t kGripUnsettled_ns = 100'000'000;
inline constexpr std::size_t kGripChanges = 16;
inline constexpr std::int64_t kGripChangesIn_ns = 1'000'000'000;

class GripSwitch {
 public:
  /// The level of this tick, true: pressed.
  void step(bool pressed, std::int64_t now_ns) RT_SAFE {
    if (pressed != level_) {
      level_ = pressed;
      changed_ns_ = now_ns;
      if (!unsettled_) unsettled_since_ns_ = now_ns;
      unsettled_ = true;
    }
    if (unsettled_ && now_ns - changed_ns_ >= kGripDebounce_ns) {
      unsettled_ = false;
      if (level_ != pressed_) note_change(now_ns);
      pressed_ = level_;
    }
    const std::int64_t sixteenth_ns = change_ns_[next_];  // the oldest of the last ones
    flaps_ = (unsettled_ && now_ns - unsettled_since_ns_ >= kGripUnsettled_ns) ||
             (changes_ >= kGripChanges && now_ns - sixteenth_ns < kGripChangesIn_ns);
  }
  bool pressed() const RT_SAFE { return pressed_; }
  bool flaps() const RT_SAFE { return flaps_; }

 private:
  void note_change(std::int64_t now_ns) RT_SAFE {
    change_ns_[next_] = now_ns;
    next_ = (next_ + 1) % kGripChanges;
    if (changes_ < kGripChanges) ++changes_;
  }

  bool level_ = false, pressed_ = false, unsettled_ = false, flaps_ = false;
  std::int64_t changed_ns_ = 0, unsettled_since_ns_ = 0;
  std::array<std::int64_t, kGripChanges> change_ns_{};
  std::size_t next_ = 0, changes_ = 0;
};

}  // namespace tact::hal::gpio
