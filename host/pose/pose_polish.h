// SPDX-License-Identifier: Apache-2.0
// pose_polish.h - reprojection error of a pose of known points, and its minimum near a start.
//
//     X = R P + t , Z > 0 ;  u = fx X/Z + cx ,  v = fy Y/Z + cy                      EP-1
//     rms^2 = (1/n) sum |(u, v) - pixel|^2
//     Gauss-Newton on the pixel residual in (rotation vector, t) until convergence   EP-10
//
//     P  point in the object's axes, m     R, t  camera <- object, t in m, +Z forward
//     fx, fy, cx, cy  pinhole without distortion, px     u, v  px
//
// Several cameras that see one object at the same time (MarkerView): the unknown pose is
// tracker <- object, X = E^-1 (R P + t) with E = tracker <- camera of each, and rms is over the
// points of all; their pixels must be of one unit, so different cameras take tangents.
//
// A step that raises rms is halved; points must stay in front of their camera. At most
// kPolishSteps steps. Source: EP-1, EP-10.
#pragma once

#include <Eigen/Core>
#include <span>

#include "host/pose/coordinate_chain.h"

namespace tact::host::pose {

struct Camera {
  double fx_px = 0.0, fy_px = 0.0;  // > 0; 1 for normalised coordinates (tangents of angles)
  double cx_px = 0.0, cy_px = 0.0;
};

inline constexpr int kPolishSteps = 50;

/// One camera's observation of the object; points and pixels correspond by their order.
struct MarkerView {
  Camera camera{};
  Pose eye{};  // tracker <- camera
  std::span<const Eigen::Vector3d> points_m;
  std::span<const Eigen::Vector2d> pixels_px;
};

/// Root mean square over the points of one or more views; infinite unless all Z > 0.
double reprojection_rms_px(std::span<const MarkerView> views, const Pose& pose);

/// EP-10 on all views, from `start`: tracker <- object; three points or more. The result's rms is
/// not above that of the start.
Pose polish_pose(std::span<const MarkerView> views, const Pose& start);

/// Root mean square distance between seen and computed pixels; infinite unless all Z > 0.
double reprojection_rms_px(const Camera& camera, std::span<const Eigen::Vector3d> points_m,
                           std::span<const Eigen::Vector2d> pixels_px, const Pose& pose);

}  // namespace tact::host::pose
