// SPDX-License-Identifier: Apache-2.0
// joint_pose.h - one pose from simultaneous observations of a body by several cameras.
//
//     rms^2 = (1/n) sum |tangent(E_i^-1 (R P + t)) - seen|^2   over the n markers of all views
//     tangent  u' = (u - cx) / fx ,  v' = (v - cy) / fy        so that pixels and sweeps compare
//
//     R, t  tracker <- body, t in m    E_i  tracker <- camera i    P  marker in the body's axes, m
//
// One camera measures depth worst: the error grows as distance squared over the body's size. A
// second camera at 30 to 120 degrees sees that depth from the side. Gauss-Newton of EP-10
// (pose_polish.h) starts from the best of the poses of the single views; the others are tried if
// the views then contradict each other.
//
//     status  kOk       every view is explained: rms of its markers <= the larger of a third of its
//                       outlier limit and twice its rms alone, and <= the outlier limit
//             kNoPose   the views contradict each other: a camera's pose is wrong, or the body
//                       moved between the observations. The caller keeps a single view.
//             kInvalid  there is no view
#pragma once

#include <vector>

#include "host/pose/epnp.h"

namespace tact::host::pose {

/// One camera's observation of a body, with pixels as tangents.
struct BodyView {
  std::vector<Eigen::Vector3d> points_m;  // of the markers that agree with `alone`
  std::vector<Eigen::Vector2d> tangents;  // as many
  double focal_px = 1.0;                  // (fx + fy) / 2: tangents to the camera's own unit
  double limit_tan = 0.0;                 // the rms above which a view is contradicted
  Pose alone{};                           // camera <- body, from this view
  Pose eye{};                             // tracker <- camera
};

/// The view of a good estimate of robust_pose; markers farther off than outlier_px are left out.
BodyView body_view(const Camera& camera, std::span<const Eigen::Vector3d> points_m,
                   std::span<const Eigen::Vector2d> pixels_px, double outlier_px,
                   const Pose& alone);

/// tracker <- body. The rms over all views, in the unit of the first one's camera, is never above
/// that of the best start.
PoseEstimate joint_pose(std::span<const BodyView> views);

}  // namespace tact::host::pose
