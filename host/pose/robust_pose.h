// SPDX-License-Identifier: Apache-2.0
// robust_pose.h - a pose that is robust against a wrong marker.
//
// Runs estimate_pose on all markers. If one of them lies farther from its computed pixel than
// `outlier_px` and there are more than kMinForOutliers, RANSAC of OpenCV (P3P on four markers,
// kRansacRounds at most, the same draws in every run) finds a consistent subset, and the pose is
// estimated and polished on it. It must have five markers or more, and more than half of all. A
// pose with an rms above `outlier_px` is rejected: with few markers an outlier cannot be found.
#pragma once

#include <vector>

#include "host/pose/epnp.h"

namespace tact::host::pose {

/// Markers of one body and their pixels, in the same order.
struct Markers {
  std::vector<Eigen::Vector3d> points_m;
  std::vector<Eigen::Vector2d> pixels_px;
};

inline constexpr std::size_t kMinForOutliers = 6;
inline constexpr int kRansacRounds = 100;

/// As estimate_pose; outlier_px > 0 in pixels or tangents, as the camera measures.
PoseEstimate robust_pose(const Camera& camera, std::span<const Eigen::Vector3d> points_m,
                         std::span<const Eigen::Vector2d> pixels_px, double outlier_px);

}  // namespace tact::host::pose
