// SPDX-License-Identifier: Apache-2.0
// clutch.h - while the clutch is pressed the tool stays and the handle moves, so that a device with
// a small workspace reaches all of a large organ.
//
//     p_tool = p_handle + s      s: shift, 0 at the start; both in W. The tool turns as before.
//
// The velocity of a sample is always that of the handle, which the gate limits.
//
//   coupled  the tool follows the handle
//   yields   pressed, the written force is not yet zero: the wanted force is zero
//   open     the written force is zero: the tool stays, s follows the handle, contact is reset
//
// After release the tool follows from its position. Contact starts again there (contact.h): a
// sphere inside the organ gives no force.
#pragma once

#include <cstdint>

#include "hal/device.h"

namespace tact::firmware::loop {

enum class ClutchState : std::uint8_t { kCoupled = 0, kYields = 1, kOpen = 2 };

class Clutch {
 public:
  /// Changes a fresh sample from handle to tool. `has_force`: the last written force is not zero.
  ClutchState step(bool pressed, bool has_force, hal::Sample& sample) RT_SAFE {
    if (!pressed) {
      state_ = ClutchState::kCoupled;
    } else if (state_ != ClutchState::kOpen) {
      state_ = has_force || !located_ ? ClutchState::kYields : ClutchState::kOpen;
      if (state_ == ClutchState::kOpen) ++count_;
    }
    // NaN latches in the controller, and must not enter the shift.
    if (!sample.fresh || !is_finite(sample.tool)) return state_;
    if (state_ == ClutchState::kOpen) shift_m_ = tool_m_ - sample.tool.position_m;
    sample.tool.position_m = sample.tool.position_m + shift_m_;
    tool_m_ = sample.tool.position_m;
    located_ = true;
    return state_;
  }
  const model::Vec3& shift_m() const RT_SAFE { return shift_m_; }
  /// How often the clutch has opened.
  std::uint32_t count() const RT_SAFE { return count_; }

 private:
  ClutchState state_ = ClutchState::kCoupled;
  bool located_ = false;  // tool_m_ is known
  model::Vec3 tool_m_{}, shift_m_{};
  std::uint32_t count_ = 0;
};

}  // namespace tact::firmware::loop
