// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/delta_plant.h"

#include <algorithm>
#include <cmath>

#include "hal/sim/sim_delta_model.h"

namespace tact::hal::sim {
namespace {

// Chosen: stiff beside any tissue; the steps stay stable, as they are implicit. Rim: README.
constexpr double kStopStiffness_Nm_per_rad = 2000.0;
constexpr double kStopDamping_Nms_per_rad = 5.0;
constexpr double kStopStiffness_N_per_m = 20e3;
constexpr double kStopDamping_Ns_per_m = 100.0;
constexpr double kStopRadius_m = kWorkspaceRadius_m + 0.020;
constexpr double kStopHalfLength_m = kWorkspaceHalfLength_m + 0.015;
constexpr int kFrictionSweeps =
    8;  // three joints, well conditioned: leaves 1e-4 of one step's push

model::Mat3 outer(const model::Vec3& a, const model::Vec3& b) RT_SAFE {
  return {{a.x * b, a.y * b, a.z * b}};
}

}  // namespace

struct DeltaPlant::Implicit {
  model::Mat3 a;            // A
  model::Vec3 momentum_Ns;  // right-hand side without friction

  /// A spring-damper along n that is `excess` beyond its rest half a step from now, before v+ has
  /// done its half: implicit in v+. Along the row of a joint `excess` is in rad, and the others are
  /// in N m / rad and N m s / rad; in space in m, N/m, N s/m.
  void resist(double dt_s, const model::Vec3& n, double excess, double stiffness,
              double damping) RT_SAFE {
    a = a + (dt_s * damping + 0.5 * dt_s * dt_s * stiffness) * outer(n, n);
    momentum_Ns -= (dt_s * stiffness * excess) * n;
  }
};

DeltaPlant::DeltaPlant(const JointFriction& friction, const model::Vec3& start_m,
                       const model::Vec3& gravity_D_mps2)
    : delta_(kGeometry),
      friction_(friction),
      gravity_D_mps2_(gravity_D_mps2),
      position_m_(start_m) {
  if (!delta_.inverse(start_m).reachable) position_m_ = {0.0, 0.0, kMiddle_D_m};
  theta_rad_ = delta_.inverse(position_m_).theta_rad;
}

void DeltaPlant::step(double dt_s, const delta::Joints& motor_Nm, const HandPull& hand) RT_SAFE {
  const delta::DeltaPose pose = delta_.pose(position_m_, theta_rad_);
  const model::Mat3 k = joint_rate_matrix(pose), k_transposed = transpose(k);
  const double inertia_kgm2 = joint_inertia_kgm2(kGeometry, kMasses);
  const model::Mat3 mass_kg =
      task_inertia_kg(kGeometry, kMasses, pose) + model::diagonal(hand.mass_kg);
  const delta::Joints gravity_Nm = gravity_torques_Nm(kGeometry, kMasses, pose, gravity_D_mps2_);
  const delta::Joints drift = joint_drift_radps2(pose, velocity_mps_);
  // K^T (tau - tau_g - I dK/dt v)
  const auto torque_Nm = [&](std::size_t i) RT_SAFE {
    return motor_Nm[i] - gravity_Nm[i] - inertia_kgm2 * drift[i];
  };
  const model::Vec3 ahead_m = position_m_ + 0.5 * dt_s * velocity_mps_;  // x+ without v+
  const model::Vec3 force_N = k_transposed * model::Vec3{torque_Nm(0), torque_Nm(1), torque_Nm(2)} +
                              hand.stiffness_N_per_m * (hand.aim_m - ahead_m) +
                              hand.damping_Ns_per_m * hand.aim_velocity_mps;
  const double hand_kg = dt_s * hand.damping_Ns_per_m + 0.5 * dt_s * dt_s * hand.stiffness_N_per_m;
  Implicit step{
      .a = mass_kg + (dt_s * friction_.viscous_Nms_per_rad) * (k_transposed * k) +
           model::diagonal(hand_kg),
      .momentum_Ns = mass_kg * velocity_mps_ + dt_s * force_N,
  };
  add_stops(dt_s, k, step);
  add_stop(dt_s, step);
  // Friction last: it needs the speed that all else would give, to know what would stop the joint.
  const model::Mat3 a_inverse = model::inverse(step.a);
  const model::Vec3 free_mps = a_inverse * step.momentum_Ns;
  move(dt_s, with_friction(free_mps, k, a_inverse, dt_s * friction_.coulomb_Nm));
}

void DeltaPlant::add_stops(double dt_s, const model::Mat3& k, Implicit& step) const RT_SAFE {
  for (std::size_t i = 0; i < 3; ++i) {
    const double above_rad = theta_rad_[i] - kGeometry.theta_max_rad;
    const double below_rad = theta_rad_[i] - kGeometry.theta_min_rad;
    const double excess_rad = above_rad > 0.0 ? above_rad : below_rad < 0.0 ? below_rad : 0.0;
    if (!(std::abs(excess_rad) > 0.0)) continue;
    const double ahead_rad = 0.5 * dt_s * dot(k.row[i], velocity_mps_);
    step.resist(dt_s, k.row[i], excess_rad + ahead_rad, kStopStiffness_Nm_per_rad,
                kStopDamping_Nms_per_rad);
  }
}

void DeltaPlant::add_stop(double dt_s, Implicit& step) const RT_SAFE {
  const double ahead_s = 0.5 * dt_s;
  const double radius_m = std::hypot(position_m_.x, position_m_.y);
  if (radius_m > kStopRadius_m) {
    const model::Vec3 outward{position_m_.x / radius_m, position_m_.y / radius_m, 0.0};
    step.resist(dt_s, outward, radius_m - kStopRadius_m + ahead_s * dot(outward, velocity_mps_),
                kStopStiffness_N_per_m, kStopDamping_Ns_per_m);
  }
  const double along_m = position_m_.z - kMiddle_D_m;
  if (std::abs(along_m) > kStopHalfLength_m) {
    const double excess_m = along_m - std::copysign(kStopHalfLength_m, along_m);
    step.resist(dt_s, {0.0, 0.0, 1.0}, excess_m + ahead_s * velocity_mps_.z, kStopStiffness_N_per_m,
                kStopDamping_Ns_per_m);
  }
}

/// Projected Gauss-Seidel from zero: each change of an impulse lowers the energy of motion, so
/// friction takes energy at any number of sweeps.
model::Vec3 DeltaPlant::with_friction(const model::Vec3& free_mps, const model::Mat3& k,
                                      const model::Mat3& a_inverse, double most_Nms) const RT_SAFE {
  if (!(most_Nms > 0.0)) return free_mps;
  const model::Mat3 mobility =
      a_inverse * transpose(k);  // column i: velocity for a unit impulse on joint i
  const model::Mat3 columns = transpose(mobility);
  model::Vec3 velocity_mps = free_mps;
  delta::Joints impulse_Nms{};
  for (int sweep = 0; sweep < kFrictionSweeps; ++sweep) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double mobility_ii = dot(k.row[i], columns.row[i]);
      // A joint in line with its rod has a row of zeros: it is not observable.
      if (!(mobility_ii > 0.0)) continue;
      // the impulse that would stop joint i, as far as friction can give it
      const double wanted_Nms = impulse_Nms[i] - dot(k.row[i], velocity_mps) / mobility_ii;
      const double next_Nms = std::clamp(wanted_Nms, -most_Nms, most_Nms);
      velocity_mps += (next_Nms - impulse_Nms[i]) * columns.row[i];
      impulse_Nms[i] = next_Nms;
    }
  }
  return velocity_mps;
}

void DeltaPlant::move(double dt_s, const model::Vec3& velocity_mps) RT_SAFE {
  // x+ = x + h (v + v+) / 2, as the header has it.
  const model::Vec3 next_m = position_m_ + 0.5 * dt_s * (velocity_mps_ + velocity_mps);
  const delta::DeltaInverse inverse = delta_.inverse(next_m);
  if (!inverse.reachable || !is_finite(velocity_mps)) {  // rods pulled tight, or NaN: dead stop
    velocity_mps_ = {};
    return;
  }
  position_m_ = next_m;
  velocity_mps_ = velocity_mps;
  theta_rad_ = inverse.theta_rad;
}

double DeltaPlant::energy_J() const RT_SAFE {
  const delta::DeltaPose pose = delta_.pose(position_m_, theta_rad_);
  const model::Vec3 momentum_Ns = task_inertia_kg(kGeometry, kMasses, pose) * velocity_mps_;
  return 0.5 * dot(velocity_mps_, momentum_Ns) +
         gravity_energy_J(kGeometry, kMasses, pose, gravity_D_mps2_);
}

}  // namespace tact::hal::sim
