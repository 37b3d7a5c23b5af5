// SPDX-License-Identifier: Apache-2.0
#include "firmware/gate/energy_tank.h"

#include <cmath>

#include "model/limits.h"

namespace tact::firmware::gate {
namespace {

// Chosen: above the rounding error of a sum over hours, far below what a hand can feel.
constexpr double kRounding_J = 1e-9;

/// Rotation between two orientations: axis times 2 sin(angle / 2). That is at most the angle, and
/// within 0.1 % of it up to 0.15 rad.
Vec3 turn_rad(const model::Quat& from, const model::Quat& to) RT_SAFE {
  const model::Quat q = to * conjugate(from);
  // q and -q are the same rotation: take the smaller angle.
  return (q.w < 0.0 ? -2.0 : 2.0) * Vec3{q.x, q.y, q.z};
}

}  // namespace

EnergyTank::EnergyTank(const EnergyTankSettings& settings)
    : settings_(settings),
      brake_mps_(settings.speed_mps + settings.lever_m * settings.turn_radps),
      level_J_(settings.budget_J) {
  // GT-2   R = min(u (Fm^2 / (2 s) + Fm dt), B / 2)
  need_J_ = model::brake_energy_J(brake_mps_, settings.force_limit_N, settings.slew_N_per_s,
                                  settings.period_s);
  reserve_J_ = std::fmin(need_J_, 0.5 * settings.budget_J);
}

void EnergyTank::observe(const model::Tool& tool, bool fresh, double periods,
                         const Wrench& held) RT_SAFE {
  held_.force_N += periods * held.force_N;
  held_.torque_Nm += periods * held.torque_Nm;
  periods_ += periods;
  if (!fresh) {  // worst case: the tool moves along the force at the speed limit
    unseen_J_ +=
        periods * settings_.period_s *
        (settings_.speed_mps * norm(held.force_N) + settings_.turn_radps * norm(held.torque_Nm));
    return;
  }
  // Mean motion per period times the sum of the held wrenches: exact at constant velocity.
  const double share = 1.0 / periods_;
  moved_m_ = is_placed_ ? share * (tool.position_m - position_m_) : Vec3{};
  turned_rad_ = is_placed_ ? share * turn_rad(orientation_, tool.orientation) : Vec3{};
  // GT-1   E <- min(2 B, E - F . dx - T . da), then back towards B
  const double budget_J = settings_.budget_J;
  const double given_energy_J = dot(held_.force_N, moved_m_) + dot(held_.torque_Nm, turned_rad_);
  const double left_J = level_J_ - given_energy_J;
  level_J_ = left_J > 2.0 * budget_J ? 2.0 * budget_J : left_J;  // NaN is kept: is_overdrawn()
  if (level_J_ < budget_J)
    level_J_ = std::fmin(budget_J, level_J_ + settings_.recovery_W * settings_.period_s * periods_);
  forget_motion();
  // The first sample after arming only sets the reference: its motion is zero.
  is_placed_ = true;
  position_m_ = tool.position_m;
  orientation_ = tool.orientation;
}

bool EnergyTank::damp(Wrench& wrench) const RT_SAFE {
  // GT-2. The bound for missed samples counts as given; the reserve is kept for the brake.
  const double room_J = std::fmax(level_J_ - unseen_J_ - reserve_J_, 0.0);
  return limit_surplus(wrench, moved_m_, turned_rad_, room_J);
}

double EnergyTank::allowed_N() const RT_SAFE {
  const double left_J = level_J_ - unseen_J_;
  if (!is_placed_ || !(left_J > 0.0)) return 0.0;
  if (left_J >= need_J_) return settings_.force_limit_N;
  // GT-3   m^2 / (2 s) + m dt = E / u, solved for m
  const double step_N = settings_.slew_N_per_s * settings_.period_s;
  return std::sqrt(step_N * step_N + 2.0 * settings_.slew_N_per_s * left_J / brake_mps_) - step_N;
}

bool EnergyTank::is_overdrawn() const RT_SAFE { return !(level_J_ >= -kRounding_J); }

}  // namespace tact::firmware::gate
