// SPDX-License-Identifier: Apache-2.0
#include "host/ros/joint_angles.h"

#include "hal/delta/delta_kinematics.h"
#include "hal/falcon/falcon_kinematics.h"

namespace tact::host::ros {
namespace {

using hal::delta::Mat3, hal::delta::Vec3;

Vec3 vector_of(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

JointState state_of(const std::array<double, 3>& angle_rad, const Vec3& rate_radps) {
  return {.angle_rad = angle_rad, .rate_radps = {rate_radps.x, rate_radps.y, rate_radps.z}};
}

}  // namespace

std::optional<JointState> joints_in(const firmware::protocol::RunHeader& run,
                                    const firmware::protocol::LoggedTick& tick) {
  const auto& sample = tick.input.sample;
  const auto& joints = run.joints;
  const auto& m = joints.row;
  const Mat3 turn{{vector_of(m[0]), vector_of(m[1]), vector_of(m[2])}};
  const Vec3 p_D =
      turn * (sample.tool.position_m - tick.input.clutch_shift_m) + vector_of(joints.origin_m);
  const Vec3 v_D = turn * sample.tool.velocity_mps;
  if (sample.sequence == 0) return std::nullopt;
  if (joints.linkage == "falcon") {
    const hal::falcon::FalconKinematics falcon;
    const auto legs = falcon.inverse(p_D);
    if (legs.reachable) return state_of(legs.thigh_rad, falcon.joint_rate_matrix(legs) * v_D);
  } else if (joints.linkage == "delta") {
    const hal::delta::DeltaKinematics delta({.base_radius_m = joints.base_radius_m,
                                             .platform_radius_m = joints.platform_radius_m,
                                             .upper_arm_m = joints.upper_arm_m,
                                             .forearm_m = joints.forearm_m,
                                             .azimuth_rad = joints.azimuth_rad});
    const auto [reachable, theta_rad] = delta.inverse(p_D);
    if (reachable) return state_of(theta_rad, joint_rate_matrix(delta.pose(p_D, theta_rad)) * v_D);
  }
  return std::nullopt;
}

}  // namespace tact::host::ros
