// SPDX-License-Identifier: Apache-2.0
// gate.h - limits every force of a law before it is written to the device. The stages run in this
// order, until one makes the force zero:
//
//   finite     NaN or infinity in force or sample: zero force and a latched fault
//   fresh      after one missed sample the force is held; from the second on, force and largest
//              permitted force ramp down to zero in 10 ms; the 20th latches
//   armed      zero unless the supervisor is in state Armed
//   workspace  ramps down to zero in 50 ms outside the permitted cylinder or above the speed limits
//   passivity  energy given to the hand <= energy taken from it + budget (GT-1 to GT-3)
//   magnitude  limits |F| and |T|: peak, and RMS over a time (GT-4)
//   slew       limits |dF| and |dT| since the last write
//   power      limits F . v + T . w (GT-5)
//   ramp       ramps up after arming
//
// Two checks that latch do not run in their stage: overdrawn energy (passivity) runs before armed,
// the power of the force to be written (power) after ramp.
//
// For every sequence of inputs the written force keeps these limits, or is zero after a fault:
//
//   |F| <= force_N, RMS <= continuous_force_N, |dF| <= slew_N_per_s dt, F . v <= power_W,
//   energy given since arming <= energy_J + recovery_W t        (torque likewise)
//
// dt is the time since the last write, skipped periods included. After a late tick, ramp-downs and
// the fall of the force advance by the whole dt: a ramp-down of 10 ms always takes 10 ms. A skipped
// period counts as a missed sample. Growth, turning and ramp-ups advance by one period.
//
// Each stage has a reason code (model/fault.h) and a counter. The gate saturates and ramps down; it
// sets zero in one step only on a stop. README.md has the proof and its three exceptions.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/gate/energy_tank.h"
#include "firmware/gate/limiter.h"
#include "firmware/gate/ramp_down.h"
#include "firmware/gate/thermal_limit.h"
#include "model/fault.h"
#include "model/limits.h"
#include "model/types.h"

namespace tact::firmware::gate {

using model::Fault;

enum class Stage : std::uint8_t {
  kFinite,
  kFresh,
  kArmed,
  kWorkspace,
  kPassivity,
  kMagnitude,
  kSlew,
  kPower,
  kRamp,
};
inline constexpr std::size_t kStageCount = 9;
inline constexpr std::array<const char*, kStageCount> kStageName{
    "finite", "fresh", "armed", "workspace", "passivity", "magnitude", "slew", "power", "ramp"};

/// Factor on the force and torque limits on a PC without hard real time.
inline constexpr double kNonRtForceShare = 0.25;

struct GateInput {
  Wrench wanted;
  model::Tool tool;  // of the newest sample
  bool fresh = false;
  bool armed = false;
  std::uint32_t skipped_periods = 0;  // between the previous tick and this one
};

struct LimitedForce {
  Wrench wrench;                // to the device
  Fault acting = Fault::kNone;  // reason code of the last stage that acted, 1..99
  Fault fault = Fault::kNone;   // 100+: the supervisor must stop
};

class Gate {
 public:
  /// `force_share` scales the magnitude limits: 1, or kNonRtForceShare.
  Gate(const model::Limits& limits, double period_s, double force_share);

  LimitedForce limit(const GateInput& input) RT_SAFE;
  /// How often each stage acted.
  const std::array<std::uint64_t, kStageCount>& counters() const RT_SAFE { return counter_; }
  double force_limit_N() const RT_SAFE { return force_limit_N_; }
  double torque_limit_Nm() const RT_SAFE { return torque_limit_Nm_; }
  double continuous_force_N() const RT_SAFE { return thermal_force_.continuous(); }
  double energy_budget_J() const RT_SAFE { return limits_.energy_J; }
  /// Energy given minus energy taken since arming.
  double given_energy_J() const RT_SAFE { return tank_.given_energy_J(); }
  double rms_force_N() const RT_SAFE { return thermal_force_.rms(); }
  double speed_limit_mps() const RT_SAFE { return limits_.speed_mps; }
  double turn_limit_radps() const RT_SAFE { return limits_.turn_radps; }
  double period_s() const RT_SAFE { return period_s_; }

 private:
  struct Magnitude {
    double force_N, torque_Nm;
  };
  /// Largest force and torque of this tick: by energy, by motor temperature, by all limits.
  struct Permitted {
    Magnitude energy, thermal, all;
  };

  void note(Stage stage, Fault reason, LimitedForce& limited) RT_SAFE;
  // One function for each stage; passivity and power also have a check that latches.
  void check_finite(const GateInput& input, LimitedForce& limited) RT_SAFE;
  void ramp_down_missed_samples(const GateInput& input, LimitedForce& limited) RT_SAFE;
  void check_energy(bool armed, LimitedForce& limited) RT_SAFE;
  bool check_armed(bool armed, LimitedForce& limited) RT_SAFE;  // false: no force
  void ramp_down_outside(const model::Tool& tool, double periods, LimitedForce& limited) RT_SAFE;
  void keep_passive(const Permitted& permitted, LimitedForce& limited) RT_SAFE;
  void limit_magnitudes(const Magnitude& thermal, LimitedForce& limited) RT_SAFE;
  void limit_slew(const Magnitude& most, double periods, LimitedForce& limited) RT_SAFE;
  void limit_power(const model::Tool& tool, const Magnitude& most, double periods,
                   LimitedForce& limited) RT_SAFE;
  void ramp_up(LimitedForce& limited) RT_SAFE;
  void check_power(const model::Tool& tool, LimitedForce& limited) RT_SAFE;

  void book_last_write(const GateInput& input, double periods) RT_SAFE;
  Permitted permitted_now() const RT_SAFE;
  bool step_towards(Wrench& w, double periods, const Magnitude& most) const RT_SAFE;
  LimitedForce without_force(LimitedForce limited) RT_SAFE;

  model::Limits limits_;
  double period_s_;
  double force_limit_N_, torque_limit_Nm_;
  double lever_m_;                        // torque limit over force limit; 0: no torque
  double force_step_N_, torque_step_Nm_;  // slew per period, minus the part kept for the ramp
  RampDown fresh_, workspace_, speed_, ramp_;
  EnergyTank tank_;
  ThermalLimit thermal_force_, thermal_torque_;
  std::int64_t missed_ = 0;  // samples in a row, one per period
  Wrench before_ramp_;       // output of stage power
  Wrench written_;
  std::array<std::uint64_t, kStageCount> counter_{};
};

}  // namespace tact::firmware::gate
