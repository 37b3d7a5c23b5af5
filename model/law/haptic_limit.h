// SPDX-License-Identifier: Apache-2.0
// haptic_limit.h - largest stiffness of a sampled spring at which the loop adds no energy.
//
//     HL-1   K_grow  = (b - abs(B)) / (T/2 + t_d)   beyond it an oscillation grows
//     HL-2   K_quiet = 2 c / D                      beyond it limit cycles of a few counts
//     HL-3   K_safe  = min(K_grow, K_quiet)         no oscillation for any hand and pose
//
//     K  stiffness of the rendered spring, N/m     T    period of the loop, s
//     b  viscous damping of the device, N s/m      t_d  age of the force beyond one hold, s
//     B  virtual damping, N s/m                    D    step of the counted position, m
//     c  Coulomb friction of the device, N
//
// b, c and D are worst-case values of the device at the tool. With t_d = 0 HL-1 is
// K < 2 (b - |B|) / T (Colgate, Schenkel, J. Robotic Systems 14 (1997) 37); for a delay it is
// the same condition at low frequency. HL-2: Coulomb friction must bear half of the step K D of the
// force at a change of the count (Abbott, Okamura, IEEE T-RO 21 (2005) 952; Diolaiti et al.,
// IEEE T-RO 22 (2006) 256). Neither assumes damping by the hand, so both hold for every hand. If a
// share p of the ticks has no fresh sample and the force is held, the mean square of the hold times
// grows and T becomes T (1 + p) / (1 - p) (HL-4). tools/stability measures all of this.
#pragma once

#include "model/device_at_tool.h"
#include "model/rt.h"

namespace tact::model::law {

struct HapticLimit {
  double grow_N_per_m = 0.0;   // K_grow: limit of every spring of a scene
  double quiet_N_per_m = 0.0;  // K_quiet; infinite if the position is not quantised
  double safe_N_per_m() const RT_SAFE {
    return grow_N_per_m < quiet_N_per_m ? grow_N_per_m : quiet_N_per_m;
  }
};

/// Invalid numbers (NaN, negative, rate 0, lost share outside [0, 1)) give a limit of zero.
HapticLimit haptic_limit(const DeviceAtTool& device, double rate_Hz,
                         double virtual_damping_Ns_per_m = 0.0, double lost_share = 0.0) RT_SAFE;

}  // namespace tact::model::law
