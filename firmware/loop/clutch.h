// SPDX-License-Identifier: Apache-2.0
// clutch.h - a small device reaches a large organ: while the clutch is pressed the tool stays where
// it is, and the hand moves the handle to another place.
//
//     p_tool = p_handle + s      s: shift, 0 at the start; both in W. The tool turns as before.
//
// The velocity of a sample stays the handle's, open or not: the gate holds it against its limit.
//
//   coupled  the tool follows the handle
//   yields   pressed, and a force is still written: none is asked for any more
//   open     no force is written: the tool stays, s follows the handle, contact is forgotten
//
// Released, the tool follows again from where it is: contact begins again there (contact.h), so a
// sphere inside the organ feels nothing.
#pragma once

#include <cstdint>

#include "hal/device.h"

namespace tact::firmware::loop {

enum class ClutchState : std::uint8_t { kCoupled = 0, kYields = 1, kOpen = 2 };

class Clutch {
 public:
  /// Moves a fresh sample from handle to tool. `has_force`: one was written in the last tick.
  ClutchState step(bool pressed, bool has_force, hal::Sample& sample) RT_SAFE {
    if (!pressed) {
      state_ = ClutchState::kCoupled;
    } else if (state_ != ClutchState::kOpen) {
      state_ = has_force || !located_ ? ClutchState::kYields : ClutchState::kOpen;
      if (state_ == ClutchState::kOpen) ++count_;
    }
    // A sample that is no number latches elsewhere, and must not stay in the shift.
    if (!sample.fresh || !is_finite(sample.tool)) return state_;
    if (state_ == ClutchState::kOpen) shift_m_ = tool_m_ - sample.tool.position_m;
    sample.tool.position_m = sample.tool.position_m + shift_m_;
    tool_m_ = sample.tool.position_m;
    located_ = true;
    return state_;
  }
  const model::Vec3& shift_m() const RT_SAFE { return shift_m_; }
  /// How often it has opened.
  std::uint32_t count() const RT_SAFE { return count_; }

 private:
  ClutchState state_ = ClutchState::kCoupled;
  bool located_ = false;  // tool_m_ is known
  model::Vec3 tool_m_{}, shift_m_{};
  std::uint32_t count_ = 0;
};

}  // namespace tact::firmware::loop
