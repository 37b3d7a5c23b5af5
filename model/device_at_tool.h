// SPDX-License-Identifier: Apache-2.0
// device_at_tool.h - a haptic device as the hand meets it: what bounds the stiffness it can show.
#pragma once

namespace tact::model {

/// At the tool, at its worst pose. The letters are those of HL-1 and HL-2.
struct DeviceAtTool {
  double damping_Ns_per_m = 0.0;  // b, >= 0
  double friction_N = 0.0;        // c, >= 0
  double position_step_m = 0.0;   // D, >= 0; 0: no counting
  double delay_s = 0.0;           // t_d, >= 0
};

}  // namespace tact::model
