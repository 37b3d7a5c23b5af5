// SPDX-License-Identifier: Apache-2.0
#include "host/pose/epnp.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <vector>

namespace tact::host::pose {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFlat = 1e-10;  // lambda_2 / lambda_1 at or below: on a line, EP-2
constexpr double kSpot = 1e-12;  // radius over distance from the origin at or below: one place

// Limits for EPnP alone: number of points, sqrt(lambda_3 / lambda_1), rms over the focal length;
// epnp.h has the evidence.
constexpr std::size_t kSurePoints = 6;
constexpr double kSureThickness = 0.3, kSure_rad = 0.0015;
// A start this near to a polished pose would converge to it.
constexpr double kNear_rad = 0.1, kNear_ratio = 0.1;

/// The points relative to their centroid, in units of their radius: independent of the unit.
struct Cloud {
  Vector3d centroid_m = Vector3d::Zero();
  double thickness = 0.0;  // sqrt(lambda_3 / lambda_1)
  double radius_m = 0.0;   // root mean square distance from the centroid; 0: on a line or a spot
  std::vector<Vector3d> points;
};

Cloud cloud_of(std::span<const Vector3d> points_m) {
  Cloud out;
  double farthest_m = 0.0;
  for (const Vector3d& p : points_m) {
    out.centroid_m += p / static_cast<double>(points_m.size());
    farthest_m = std::max(farthest_m, p.stableNorm());
  }
  double radius_m = 0.0;  // the largest, so that squares neither overflow nor underflow
  for (const Vector3d& p : points_m)
    radius_m = std::max(radius_m, (p - out.centroid_m).stableNorm());
  // Far from the origin, points in one place differ only by rounding.
  if (!(radius_m > kSpot * farthest_m)) return out;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points_m) {
    const Vector3d d = (p - out.centroid_m) / radius_m;
    covariance += d * d.transpose() / static_cast<double>(points_m.size());
  }
  const Vector3d lambda =  // ascending
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly)
          .eigenvalues();
  if (!(lambda[1] > kFlat * lambda[2])) return out;
  out.thickness = std::sqrt(std::max(lambda[0], 0.0) / lambda[2]);
  out.radius_m = radius_m * std::sqrt(covariance.trace());
  for (const Vector3d& p : points_m) out.points.push_back((p - out.centroid_m) / out.radius_m);
  return out;
}

/// Four points far apart: the outermost, then three times the one farthest from those chosen.
std::array<std::size_t, 4> widest_four(std::span<const Vector3d> points) {
  // P3P on a small triangle amplifies the noise of the pixels.
  std::array<std::size_t, 4> taken{};
  const auto gap = [&](std::size_t i, std::size_t count) {
    double least = count == 0 ? points[i].norm() : std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < count; ++k)
      least = std::min(least, (points[i] - points[taken[k]]).norm());
    return least;
  };
  for (std::size_t count = 0; count < 4; ++count) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
      if (gap(i, count) > gap(best, count)) best = i;
    taken[count] = best;
  }
  return taken;
}

/// Points and pixels in OpenCV's types.
struct Views {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;

  void add(const Vector3d& point, const Vector2d& pixel) {
    points.emplace_back(point.x(), point.y(), point.z());
    pixels.emplace_back(pixel.x(), pixel.y());
  }
};

void add_poses(const std::vector<cv::Mat>& turns, const std::vector<cv::Mat>& shifts,
               std::vector<Pose>& poses) {
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const Vector3d turn(turns[i].at<double>(0), turns[i].at<double>(1), turns[i].at<double>(2));
    const Vector3d t(shifts[i].at<double>(0), shifts[i].at<double>(1), shifts[i].at<double>(2));
    // OpenCV may return NaN for a view without a solution.
    if (!turn.allFinite() || !t.allFinite()) continue;
    const double angle_rad = turn.norm();
    Pose pose{.rotation = Quaterniond::Identity(), .position_m = t};
    if (angle_rad > 0.0) pose.rotation = Eigen::AngleAxisd(angle_rad, turn / angle_rad);
    poses.push_back(pose);
  }
}

/// The start poses that OpenCV computes.
class Starts {
 public:
  Starts(const Camera& camera, std::span<const Vector3d> points,
         std::span<const Vector2d> pixels_px)
      : lens_(camera.fx_px, 0.0, camera.cx_px, 0.0, camera.fy_px, camera.cy_px, 0.0, 0.0, 1.0),
        points_(points),
        pixels_px_(pixels_px) {}

  /// EP-3 .. EP-9 on all points.
  std::vector<Pose> epnp() const {
    Views all;
    for (std::size_t i = 0; i < points_.size(); ++i) all.add(points_[i], pixels_px_[i]);
    std::vector<Pose> poses;
    collect(poses, [&](auto& turns, auto& shifts) {
      cv::solvePnPGeneric(all.points, all.pixels, lens_, cv::noArray(), turns, shifts, false,
                          cv::SOLVEPNP_EPNP);
    });
    return poses;
  }

  /// P3P on the four triangles of the four widest points.
  std::vector<Pose> p3p() const {
    std::vector<Pose> poses;
    const std::array<std::size_t, 4> four = widest_four(points_);
    for (const std::size_t left_out : four) {
      Views triangle;
      for (const std::size_t i : four)
        if (i != left_out) triangle.add(points_[i], pixels_px_[i]);
      if (triangle.points.size() != 3) continue;  // two of the four are the same point
      collect(poses, [&](auto& turns, auto& shifts) {
        cv::solveP3P(triangle.points, triangle.pixels, lens_, cv::noArray(), turns, shifts,
                     cv::SOLVEPNP_AP3P);
      });
    }
    return poses;
  }

 private:
  /// OpenCV reports errors by exceptions; the results of the other starts are kept.
  static void collect(std::vector<Pose>& poses, auto solve) {
    try {
      std::vector<cv::Mat> turns, shifts;
      solve(turns, shifts);
      add_poses(turns, shifts, poses);
    } catch (const cv::Exception&) {
    }
  }

  cv::Matx33d lens_;
  std::span<const Vector3d> points_;
  std::span<const Vector2d> pixels_px_;
};

/// True if `start` would converge to a pose that is already polished.
bool is_near(const Pose& start, const Pose& polished) {
  return start.rotation.angularDistance(polished.rotation) < kNear_rad &&
         (start.position_m - polished.position_m).norm() < kNear_ratio * polished.position_m.norm();
}

bool is_focal(double f_px) { return f_px > 0.0 && std::isfinite(f_px); }

bool is_valid(const Camera& camera, std::span<const Vector3d> points_m,
              std::span<const Vector2d> pixels_px) {
  return is_focal(camera.fx_px) && is_focal(camera.fy_px) && std::isfinite(camera.cx_px) &&
         std::isfinite(camera.cy_px) && points_m.size() == pixels_px.size() &&
         std::ranges::all_of(points_m, [](const Vector3d& p) { return p.allFinite(); }) &&
         std::ranges::all_of(pixels_px, [](const Vector2d& p) { return p.allFinite(); });
}

}  // namespace

PoseEstimate estimate_pose(const Camera& camera, std::span<const Vector3d> points_m,
                           std::span<const Vector2d> pixels_px) {
  if (!is_valid(camera, points_m, pixels_px)) return {};
  if (points_m.size() < 4) return {.status = PoseStatus::kTooFewPoints};
  // In units of the body's radius, so that results do not depend on the unit.
  const Cloud cloud = cloud_of(points_m);
  if (cloud.points.empty()) return {.status = PoseStatus::kDegenerate};

  PoseEstimate out{.status = PoseStatus::kNoPose,
                   .rms_px = std::numeric_limits<double>::infinity()};
  const MarkerView view{.camera = camera, .points_m = cloud.points, .pixels_px = pixels_px};
  std::vector<Pose> polished;
  const auto try_all = [&](const std::vector<Pose>& found) {
    for (const Pose& start : found) {
      const bool known =
          std::ranges::any_of(polished, [&](const Pose& pose) { return is_near(start, pose); });
      // Polishing takes most of the time: skip a start that would end at a known pose.
      if (known) continue;
      const Pose pose = polish_pose({&view, 1}, start);
      polished.push_back(pose);
      const double rms_px = reprojection_rms_px({&view, 1}, pose);
      // EP-9: the smallest rms; it is infinite if a point lies behind the camera.
      if (!(rms_px < out.rms_px)) continue;
      out = {.status = PoseStatus::kOk, .pose = pose, .rms_px = rms_px};
    }
  };
  const Starts starts(camera, cloud.points, pixels_px);
  try_all(starts.epnp());
  const bool is_sure = points_m.size() >= kSurePoints && cloud.thickness > kSureThickness &&
                       out.rms_px < kSure_rad * std::min(camera.fx_px, camera.fy_px);
  if (!is_sure) try_all(starts.p3p());
  if (out.status != PoseStatus::kOk) return {.status = PoseStatus::kNoPose};
  // X = R (P - c) / r + t'  in units of r, so  t = r t' - R c
  out.pose.rotation = canonical(out.pose.rotation);
  out.pose.position_m = cloud.radius_m * out.pose.position_m - out.pose.rotation * cloud.centroid_m;
  return out;
}

}  // namespace tact::host::pose
