// SPDX-License-Identifier: Apache-2.0
// delta_at_tool.h - what the joints of a delta are worth at the tool, where they are worst.
//
//     b = b_joint / s^2      c = c_joint / s      D = s 2 pi / counts
//
// s: largest singular value of J over the given poses, m/rad: where a turning joint moves the tool
// most, its friction helps least and its counts are coarsest.
#pragma once

#include <span>
#include <vector>

#include "hal/delta/delta_kinematics.h"
#include "model/device_at_tool.h"

namespace tact::hal::delta {

struct DeltaJointQuality {
  double viscous_Nms_per_rad = 0.0;  // b_joint
  double coulomb_Nm = 0.0;           // c_joint
  double counts_per_turn = 0.0;
  double delay_s = 0.0;  // from position to force, beyond one hold
};

/// The middle and the edges of a workspace cylinder along W x, in frame D (delta_frame.h).
std::vector<Vec3> workspace_samples_D(double radius_m, double half_length_m, double middle_m);

/// Positions in frame D; those out of reach are not looked at.
model::DeviceAtTool delta_at_tool(const DeltaKinematics& delta, const DeltaJointQuality& joint,
                                  std::span<const Vec3> positions_m);

}  // namespace tact::hal::delta
