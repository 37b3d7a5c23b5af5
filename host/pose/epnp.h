// SPDX-License-Identifier: Apache-2.0
// epnp.h - the pose of an object from the pixels of n >= 4 known points (EPnP).
//
//     status  kTooFewPoints n < 4     kInvalid  a number is not finite, fx or fy <= 0
//             kDegenerate   the points are on a line or in one place: lambda_2 <= 1e-10 lambda_1
//                           (eigenvalues of their covariance, descending)                  EP-2
//             kNoPose       no pose has all points in front of the camera
//
// Two kinds of start by OpenCV (calib3d): EPnP [1] on all points (EP-3 .. EP-9), and P3P [2] on the
// four triangles of the four widest points. EPnP alone misses the pose in 3 of 100 views of four
// points and in 12 to 49 of 100 of a flat object (2000 random views without noise, polished;
// epnp_test shows it). Each pose found is polished on the pixels (EP-10); the one with the smallest
// rms is kept. P3P is skipped if EPnP is reliable: six points or more, as thick as 0.3 of their
// length (sqrt(lambda_3 / lambda_1)), and an rms below 1.5 mrad. That is five times faster and was
// worse in none of 240 000 random views of such bodies. With noise, few or flat points and a
// distant view, a mirrored pose can explain the pixels better than the true one: use n >= 6 points
// that are not in a plane.
//
// Points in any unit of length; t comes in the same. A sweep tracker that measures angles gives
// u = tan azimuth, v = tan elevation with fx = fy = 1, cx = cy = 0. Not for the force loop.
//
// [1] V. Lepetit, F. Moreno-Noguer, P. Fua, Int. J. Computer Vision 81 (2009) 155-166.
// [2] T. Ke, S. Roumeliotis, IEEE Conf. Computer Vision and Pattern Recognition (2017) 4618-4626.
#pragma once

#include <cstdint>

#include "host/pose/pose_polish.h"

namespace tact::host::pose {

enum class PoseStatus : std::uint8_t { kOk, kTooFewPoints, kDegenerate, kInvalid, kNoPose };

struct PoseEstimate {
  PoseStatus status = PoseStatus::kInvalid;
  Pose pose{};  // camera <- object: X = rotation P + position
  double rms_px = 0.0;
};

/// Pixels and points: equal numbers, in the same order.
PoseEstimate estimate_pose(const Camera& camera, std::span<const Eigen::Vector3d> points_m,
                           std::span<const Eigen::Vector2d> pixels_px);

}  // namespace tact::host::pose
