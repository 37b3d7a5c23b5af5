// SPDX-License-Identifier: Apache-2.0
// mechanism.h - what the emulated platform knows of the three-armed mechanism that carries it.
//
//     theta' = K v        tau = J^T F,  so  F = K^T tau        weight = -dV/dp
//
// Everything is in W (+x towards the operator, +y right, +z up, m, N, rad); theta and K have one
// row per arm. Own reading of the public equations: nothing here comes from the drivers under test.
#pragma once

#include <array>
#include <optional>

#include "model/types.h"

namespace tact::rig {

using model::Vec3;

/// One number per arm.
using Joints = std::array<double, 3>;

struct Pose {
  Joints theta_rad{};
  std::array<Vec3, 3> k_rad_per_m{};  // rows of K
  Vec3 weight_N{};                    // what gravity does to the platform
  bool at_stop = false;               // the arms reach, but are nearly stretched
};

/// F = K^T tau, the force of joint torques on the platform.
constexpr Vec3 force_of(const Pose& pose, const Joints& tau_Nm) {
  Vec3 force_N;
  for (std::size_t i = 0; i < 3; ++i) force_N += pose.k_rad_per_m[i] * tau_Nm[i];
  return force_N;
}
/// tau = J^T F = (K^T)^-1 F by Cramer's rule.
constexpr Joints torque_of(const Pose& pose, const Vec3& force_N) {
  const auto& k = pose.k_rad_per_m;
  const double volume = model::dot(k[0], model::cross(k[1], k[2]));
  Joints tau_Nm{};
  for (std::size_t i = 0; i < 3; ++i)
    tau_Nm[i] = model::dot(force_N, model::cross(k[(i + 1) % 3], k[(i + 2) % 3])) / volume;
  return tau_Nm;
}

/// The mechanism as the platform meets it.
class Mechanism {
 public:
  virtual ~Mechanism() = default;
  /// Nothing where the arms do not reach, or where the stops are.
  virtual std::optional<Pose> pose(const Vec3& position_m) const = 0;
  virtual double mass_kg() const = 0;
  virtual double viscous_Nms_per_rad() const = 0;  // per joint
  virtual double coulomb_Nm() const = 0;           // per joint
};

}  // namespace tact::rig
