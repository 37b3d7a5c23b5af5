// SPDX-License-Identifier: Apache-2.0
#include "host/pose/robust_pose.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <vector>

namespace tact::host::pose {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// P3P uses four markers, so a fifth that agrees is the first evidence.
constexpr std::size_t kMinInliers = 5;
constexpr double kConfidence = 0.999;  // that at least one draw has no outlier

bool all_within(const Camera& camera, std::span<const Vector3d> points_m,
                std::span<const Vector2d> pixels_px, const Pose& pose, double outlier_px) {
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const double off_px =
        reprojection_rms_px(camera, points_m.subspan(i, 1), pixels_px.subspan(i, 1), pose);
    if (!(off_px <= outlier_px)) return false;
  }
  return true;
}

/// The markers that agree with one pose; none if there are too few. In normalised coordinates, so
/// that pixels and tangents are treated alike.
Markers agreeing(const Camera& camera, std::span<const Vector3d> points_m,
                 std::span<const Vector2d> pixels_px, double outlier_px) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> tangents;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    points.emplace_back(points_m[i].x(), points_m[i].y(), points_m[i].z());
    tangents.emplace_back((pixels_px[i].x() - camera.cx_px) / camera.fx_px,
                          (pixels_px[i].y() - camera.cy_px) / camera.fy_px);
  }
  // The smaller focal length gives the larger tangent, so no good marker is lost by unequal axes.
  const double f_px = std::min(camera.fx_px, camera.fy_px);
  std::vector<int> chosen;
  try {
    cv::Vec3d turn, shift;
    const bool found = cv::solvePnPRansac(
        points, tangents, cv::Matx33d::eye(), cv::noArray(), turn, shift, false, kRansacRounds,
        static_cast<float>(outlier_px / f_px), kConfidence, chosen, cv::SOLVEPNP_AP3P);
    if (!found) return {};
  } catch (const cv::Exception&) {
    return {};
  }
  Markers out;
  // Half of all or fewer may agree with a wrong pose.
  if (chosen.size() < kMinInliers || 2 * chosen.size() <= points.size()) return out;
  for (const int i : chosen) {
    out.points_m.push_back(points_m[static_cast<std::size_t>(i)]);
    out.pixels_px.push_back(pixels_px[static_cast<std::size_t>(i)]);
  }
  return out;
}

}  // namespace

PoseEstimate robust_pose(const Camera& camera, std::span<const Vector3d> points_m,
                         std::span<const Vector2d> pixels_px, double outlier_px) {
  PoseEstimate out = estimate_pose(camera, points_m, pixels_px);
  const bool may_choose = points_m.size() > kMinForOutliers;
  if (may_choose && (out.status == PoseStatus::kOk || out.status == PoseStatus::kNoPose) &&
      !(out.status == PoseStatus::kOk &&
        all_within(camera, points_m, pixels_px, out.pose, outlier_px))) {
    const Markers good = agreeing(camera, points_m, pixels_px, outlier_px);
    if (good.points_m.empty()) return {.status = PoseStatus::kNoPose};
    out = estimate_pose(camera, good.points_m, good.pixels_px);
  }
  if (out.status == PoseStatus::kOk && !(out.rms_px <= outlier_px))
    return {.status = PoseStatus::kNoPose};
  return out;
}

}  // namespace tact::host::pose
