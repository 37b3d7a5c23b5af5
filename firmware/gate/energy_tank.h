// SPDX-License-Identifier: Apache-2.0
// energy_tank.h - limits the energy that the device gives to the hand: time-domain passivity
// control (Hannaford, Ryu, IEEE T-RA 18 (2002) 1) with an energy tank (Franken et al., IEEE T-RO 27
// (2011) 741).
//
//     GT-1   observer     E <- min(2 B, E - F . dx - T . da)   F, T held since the last sample
//                         E <- min(B, E + Pr dt)               where E < B; E = B at arming
//     GT-2   controller   F . dx + T . da <= E - R             predicted: the last motion again
//     GT-3   brake        u (m^2 / (2 s) + m dt) <= E          m: largest |F|, and |T| / l
//
//     E   energy left in the tank, J        B   budget, J           Pr  recovery, W
//     dx  displacement, m                   da  rotation, rad       u   largest speed v + w l, m/s
//     s   slew, N/s                         l   lever, m: torque limit over force limit
//     R   energy that the brake needs for the largest force, at most B / 2
//
// The force is constant between two writes, so the observer is exact (rotation: to 0.1 %, as it
// uses 2 sin(angle/2)). If samples are missed, it uses the mean force since the last sample; that
// is exact at constant velocity. The controller removes only the force along the motion: the least
// damping. Its prediction fails if the hand reverses within a period. The brake predicts nothing:
//
//     E >= 0 for every input that moves at most v dt and turns at most w dt in a period.
//
// Proof: a force m that falls at the slew limit while the tool moves at u gives at most the energy
// on the left of GT-3, and GT-3 permits m only if the tank holds it. In t seconds since arming the
// device therefore gives at most B + Pr t more than it took, in any other t seconds 2 B + Pr t.
// A longer step (speed above the limit, or a longer period without a sample) can overdraw the tank,
// by less than the energy of that tick; the gate then latches in the same tick.
#pragma once

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

  /// GT-1: `held` was applied for `periods` periods; its energy is booked at the next fresh sample.
  void observe(const model::Tool& tool, bool fresh, double periods, const Wrench& held) RT_SAFE;
  /// GT-2. True if it reduced the wrench.
  bool damp(Wrench& wrench) const RT_SAFE;
  /// GT-3: largest force that may be written now; the largest torque is that times the lever.
  double allowed_N() const RT_SAFE;
  /// The energy in the tank is negative.
  bool is_overdrawn() const RT_SAFE;
  /// Energy given minus energy taken, J; not below -B.
  double given_energy_J() const RT_SAFE { return settings_.budget_J - level_J_; }
  /// Without force on the hand: E = B. Permits no force before the next fresh sample.
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
  double need_J_;          // that the brake needs for the largest force
  double reserve_J_;       // R
  double level_J_;         // E
  double unseen_J_ = 0.0;  // upper bound of the energy given since the last fresh sample
  Wrench held_;            // sum over the periods since then
  double periods_ = 0.0;
  bool is_placed_ = false;  // a sample has come since the last refill
  Vec3 position_m_;         // of the last sample
  model::Quat orientation_;
  Vec3 moved_m_, turned_rad_;  // per period, between the last two samples
};

}  // namespace tact::firmware::gate
