// SPDX-License-Identifier: Apache-2.0
#include "host/pose/pose_polish.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace tact::host::pose {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kStill = 1e-12;  // a smaller step has converged: rad, and shift over distance
constexpr double kFine = 1e-8;    // a smaller step that no longer shrinks is rounding
// Near the minimum rms is flat: a pose moves by 1e-8 while rms changes only by rounding.
constexpr double kRounding = 1.0 + 1e-12;
// 2^-16 of a step: if rms has not fallen by then, the difference is rounding.
constexpr int kHalvings = 16;

Vector2d pixel_of(const Camera& camera, const Vector3d& x) {
  return {camera.fx_px * x.x() / x.z() + camera.cx_px, camera.fy_px * x.y() / x.z() + camera.cy_px};
}

/// The pose after a small turn (rotation vector, in the tracker's axes) and shift.
Pose moved(const Pose& pose, const Vector6d& step) {
  const Vector3d turn = step.head<3>();
  const double angle_rad = turn.norm();
  Pose out = pose;
  if (angle_rad > 0.0)
    out.rotation = (Eigen::AngleAxisd(angle_rad, turn / angle_rad) * pose.rotation).normalized();
  out.position_m += step.tail<3>();
  return out;
}

/// (camera <- tracker): E^-1 of a view, computed once for all points.
struct Sight {
  explicit Sight(const Pose& eye) : turn(eye.rotation.conjugate()), eye_m(eye.position_m) {}
  Vector3d operator()(const Vector3d& x_m) const { return turn * (x_m - eye_m); }
  Eigen::Matrix3d turn;
  Vector3d eye_m;
};

std::size_t count_points(std::span<const MarkerView> views) {
  std::size_t out = 0;
  for (const MarkerView& view : views) out += view.points_m.size();
  return out;
}

/// The Gauss-Newton step: least squares of J step = pixel - (u, v).
Vector6d gauss_newton_step(std::span<const MarkerView> views, const Pose& pose) {
  const auto rows = static_cast<Index>(2 * count_points(views));
  Eigen::Matrix<double, Eigen::Dynamic, 6> jacobian(rows, 6);
  Eigen::VectorXd residual(rows);
  Index row = 0;
  for (const MarkerView& view : views) {
    const Camera& camera = view.camera;
    const Sight sight(view.eye);
    for (std::size_t i = 0; i < view.points_m.size(); ++i, row += 2) {
      const Vector3d turned = pose.rotation * view.points_m[i];
      const Vector3d x = sight(turned + pose.position_m);
      // du = fx (dX - X/Z dZ)/Z ,  dv = fy (dY - Y/Z dZ)/Z ,  dX = E^-1 (w x (R P) + dt)
      Eigen::Matrix<double, 2, 3> by_x;
      by_x << camera.fx_px / x.z(), 0.0, -camera.fx_px * x.x() / (x.z() * x.z()),  //
          0.0, camera.fy_px / x.z(), -camera.fy_px * x.y() / (x.z() * x.z());
      const Eigen::Matrix<double, 2, 3> by_shift = by_x * sight.turn;
      for (Index axis = 0; axis < 3; ++axis)
        jacobian.block<2, 1>(row, axis) = by_shift * Vector3d::Unit(axis).cross(turned);
      jacobian.block<2, 3>(row, 3) = by_shift;
      residual.segment<2>(row) = view.pixels_px[i] - pixel_of(camera, x);
    }
  }
  // QR, because the normal equations would square the condition number of a flat or distant body.
  return jacobian.colPivHouseholderQr().solve(residual);
}

}  // namespace

double reprojection_rms_px(std::span<const MarkerView> views, const Pose& pose) {
  double sum_px2 = 0.0;
  for (const MarkerView& view : views) {
    const Sight sight(view.eye);
    for (std::size_t i = 0; i < view.points_m.size(); ++i) {
      const Vector3d x = sight(to_world(pose, view.points_m[i]));
      // Behind the camera the projection is a mirror image with a good rms: always refused.
      if (!(x.z() > 0.0)) return std::numeric_limits<double>::infinity();
      sum_px2 += (pixel_of(view.camera, x) - view.pixels_px[i]).squaredNorm();
    }
  }
  return std::sqrt(sum_px2 / static_cast<double>(count_points(views)));
}

double reprojection_rms_px(const Camera& camera, std::span<const Vector3d> points_m,
                           std::span<const Vector2d> pixels_px, const Pose& pose) {
  const MarkerView view{.camera = camera, .points_m = points_m, .pixels_px = pixels_px};
  return reprojection_rms_px({&view, 1}, pose);
}

Pose polish_pose(std::span<const MarkerView> views, const Pose& start) {
  Pose pose = start;
  double best_px = reprojection_rms_px(views, pose);
  double last_size = std::numeric_limits<double>::infinity();
  // A start behind the camera has an infinite rms, so no descent can be measured.
  if (!std::isfinite(best_px)) return pose;
  for (int i = 0; i < kPolishSteps; ++i) {
    Vector6d step = gauss_newton_step(views, pose);
    if (!step.allFinite()) return pose;
    Pose next = moved(pose, step);
    double next_px = reprojection_rms_px(views, next);
    for (int h = 0; h < kHalvings && !(next_px <= kRounding * best_px); ++h) {
      step *= 0.5;
      next = moved(pose, step);
      next_px = reprojection_rms_px(views, next);
    }
    if (!(next_px <= kRounding * best_px)) return pose;  // no descent
    pose = next;
    best_px = std::min(best_px, next_px);
    const double distance_m = (pose.position_m - views.front().eye.position_m).norm();
    // Shift over distance, so that both parts are angles.
    const double size = step.head<3>().norm() + step.tail<3>().norm() / distance_m;
    if (size < kStill || (size < kFine && size >= last_size)) break;
    last_size = size;
  }
  return pose;
}

}  // namespace tact::host::pose
