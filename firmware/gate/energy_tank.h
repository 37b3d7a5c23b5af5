// SPDX-License-Identifier: Apache-2.0
// energy_tank.h - how much energy the device may still give to the hand: passivity in the time
// domain (Hannaford, Ryu, IEEE T-RA 18 (2002) 1), kept as a tank (Franken et al., IEEE T-RO 27
// (2011) 741).
//
//     GT-1   observer     E <- min(2 B, E - F . dx - T . da)   F, T held since the sample before
//                         E <- min(B, E + Pr dt)               where E < B; E = B at arming
//     GT-2   controller   F . dx + T . da <= E - R             foreseen: the motion before this one
//     GT-3   brake        u (m^2 / (2 s) + m dt) <= E          m: largest |F|, and |T| / l
//
//     E   what may still be given, J        B   budget, J           Pr  what comes back, W
//     dx  displacement, m                   da  rotation, rad       u   largest speed v + w l, m/s
//     s   slew, N/s                         l   lever, m: torque limit over force limit
//     R   what the brake needs for the largest force, at most B / 2
//
// A held force makes the observer exact (a rotation to 0.1 %: 2 sin(angle/2)). With missed samples
// it takes their mean force, exact for a steady motion. The controller takes from the force what
// pushes along the motion, no more: the least damping. It can be wrong, as the hand may turn round
// within a period; the brake cannot:
//
//     E >= 0 for every input that moves at most v dt and turns at most w dt in a period,
//
// as what a force gives at u while it falls at the slew is m^2 / (2 s) + m dt at most, and that is
// there before the force is. So since arming the device gives at most B + Pr t more than it took,
// in any t seconds 2 B + Pr t. A longer step (faster than the limit, or a period that lasted longer
// without a sample) can leave less than the brake needs: the gate latches in the tick in which the
// tank is overdrawn, by less than what that one tick gave.
#pragma once

#include <cstdint>

#include "firmware/gate/limiter.h"

namespace tact::firmware::gate {

struct EnergyTankSettings {
  double budget_J = 0.0;    // B
  double recovery_W = 0.0;  // Pr
  double speed_mps = 0.0;   // v
  double turn_radps = 0.0;  // w
  double force_limit_N = 0.0;
  double lever_m = 0.0;       // l; 0: no torque
  double slew_N_per_s = 0.0;  // s
  double period_s = 0.0;      // dt
};

class EnergyTank {
 public:
  explicit EnergyTank(const EnergyTankSettings& settings);

  /// What the wrench that was held for so many periods has given, once a fresh sample tells.
  void observe(const model::Tool& tool, bool fresh, double periods, const Wrench& held) RT_SAFE;
  /// True if it had to take from the wrench.
  bool damp(Wrench& wrench) const RT_SAFE;
  /// Largest force that may be written now; the largest torque is that times the lever.
  double allowed_N() const RT_SAFE;
  /// More was given than there was.
  bool is_overdrawn() const RT_SAFE;
  /// Given more than taken, J; -B: much was taken.
  double given_J() const RT_SAFE { return settings_.budget_J - level_J_; }
  /// A new budget, as nobody is pushed now; no force before the next fresh sample.
  void refill() RT_SAFE {
    level_J_ = settings_.budget_J;
    forget_motion();
    is_placed_ = false;
  }

 private:
  void forget_motion() RT_SAFE {
    held_ = {};
    periods_ = 0.0;
    unseen_J_ = 0.0;
  }

  EnergyTankSettings settings_;
  double brake_mps_;       // u
  double need_J_;          // of the brake, for the largest force
  double reserve_J_;       // R
  double level_J_;         // E
  double unseen_J_ = 0.0;  // at most given since the last fresh sample
  Wrench held_;            // sum over the periods since then
  double periods_ = 0.0;
  bool is_placed_ = false;  // there was a sample
  Vec3 position_m_;         // of it
  model::Quat orientation_;
  Vec3 moved_m_, turned_rad_;  // in the last period that is known
};

}  // namespace tact::firmware::gate
