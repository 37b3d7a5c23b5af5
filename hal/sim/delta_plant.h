// SPDX-License-Identifier: Apache-2.0
// delta_plant.h - the mechanics of the simulated delta, with the hand that holds it.
//
//     A v+ = M v + h (K^T (tau - tau_g) - I K^T (dK/dt v) + k (x_h - x - h v / 2) + b v_h)
//            + K^T lambda
//     A    = M + h c K^T K + (h b + h^2 k / 2) 1,      x+ = x + h (v + v+) / 2
//
//     M = I K^T K + m 1  mass of joints, platform and hand, kg;  thetadot = K v
//     tau, tau_g         motor and gravity torque, N m;  c  viscous joint friction, N m s/rad
//     k, b, x_h, v_h     spring, damper and aim of the hand
//     lambda             impulse of Coulomb friction: what stops joint i, at most h tau_c
//
// I K^T (dK/dt v) is all that Coriolis and centrifugal forces leave in these coordinates. Dampers,
// springs and stops are implicit in v+ and x+, so any stiffness is stable and friction only takes
// energy. A force that is held over the step moves the tool as far as it really would: with
// x+ = x + h v+ the loop would see h / 2 ahead, worth K h / 2 of damping for a wall of stiffness K.
// Joint stops at -50 and 95 deg and a rim around the cylinder, 20 mm beyond its wall and 15 mm
// beyond its ends, keep arms and rods well away from every singular pose. Frame D.
#pragma once

#include "hal/delta/delta_dynamics.h"
#include "hal/delta/delta_frame.h"
#include "hal/delta/delta_kinematics.h"

namespace tact::hal::sim {

struct JointFriction {
  double coulomb_Nm = 0.0;
  double viscous_Nms_per_rad = 0.0;
};

/// What the hand does in one step, frame D. All zero: no hand.
struct HandPull {
  double mass_kg = 0.0;
  double stiffness_N_per_m = 0.0;
  double damping_Ns_per_m = 0.0;
  model::Vec3 aim_m;
  model::Vec3 aim_velocity_mps;
};

class DeltaPlant {
 public:
  /// At rest at start_m, or in the middle of the workspace if that is out of reach.
  DeltaPlant(const JointFriction& friction, const model::Vec3& start_m,
             const model::Vec3& gravity_D_mps2 = delta::direction_D(delta::kGravity_W_mps2));

  void step(double dt_s, const delta::Joints& motor_Nm, const HandPull& hand) RT_SAFE;

  const model::Vec3& position_D_m() const RT_SAFE { return position_m_; }
  const model::Vec3& velocity_mps() const RT_SAFE { return velocity_mps_; }
  const delta::Joints& theta_rad() const RT_SAFE { return theta_rad_; }
  /// Motion and gravity, without the hand; stops hold a little more while they are pressed.
  double energy_J() const RT_SAFE;

 private:
  struct Implicit;  // what one step adds to A and to the right-hand side

  void add_stops(double dt_s, const model::Mat3& k, Implicit& step) const RT_SAFE;
  void add_stop(double dt_s, Implicit& step) const RT_SAFE;
  model::Vec3 with_friction(const model::Vec3& free_mps, const model::Mat3& k,
                            const model::Mat3& a_inverse, double most_Nms) const RT_SAFE;
  void move(double dt_s, const model::Vec3& velocity_mps) RT_SAFE;

  delta::DeltaKinematics delta_;
  JointFriction friction_;
  model::Vec3 gravity_D_mps2_;
  model::Vec3 position_m_;
  model::Vec3 velocity_mps_;
  delta::Joints theta_rad_{};
};

}  // namespace tact::hal::sim
