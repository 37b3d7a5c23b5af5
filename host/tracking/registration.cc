// SPDX-License-Identifier: Apache-2.0
#include "host/tracking/registration.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "model/io/file_writer.h"
#include "model/io/input_file.h"

namespace tact::host::tracking {
namespace {

namespace fs = std::filesystem;
using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using model::Error;
using model::Result;
using Points = Eigen::Matrix<double, 3, Eigen::Dynamic>;  // 3 x n

/// Spread across the best-fitting line, m.
double spread_m(const Points& points) {
  const Points centred = points.colwise() - points.rowwise().mean();
  const Matrix3d covariance = centred * centred.transpose() / static_cast<double>(points.cols());
  const Vector3d lambda =
      Eigen::SelfAdjointEigenSolver<Matrix3d>(covariance, Eigen::EigenvaluesOnly).eigenvalues();
  // Ascending: the second eigenvalue is the spread across the best line, 0 on a line.
  return std::sqrt(std::max(lambda[1], 0.0));
}

}  // namespace

Result<Registration> fit_registration(std::span<const PosePair> poses) {
  if (poses.size() < kMinPoses) {
    return Error{fmt::format("{} poses are too few for a registration; take {} or more",
                             poses.size(), kMinPoses)};
  }
  Points tracked(3, static_cast<Index>(poses.size())), device(3, static_cast<Index>(poses.size()));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    tracked.col(static_cast<Index>(i)) = poses[i].tracked_m;
    device.col(static_cast<Index>(i)) = poses[i].device_m;
  }
  if (!tracked.allFinite() || !device.allFinite())
    return Error{"a pose is not finite; look at the tracker and take the poses again"};
  if (!(spread_m(tracked) >= kMinSpread_m && spread_m(device) >= kMinSpread_m))
    return Error{
        "the poses lie on a line or in one place; move the tool in two directions or more"};
  // Without scale: both sides are in metres, and a scale would hide a wrong marker.
  const Eigen::Matrix4d fit = Eigen::umeyama(tracked, device, /*with_scaling=*/false);
  Registration out;
  out.transform.rotation =
      pose::canonical(Eigen::Quaterniond(Matrix3d(fit.topLeftCorner<3, 3>())).normalized());
  out.transform.position_m = fit.topRightCorner<3, 1>();
  double sum_m2 = 0.0;
  for (const PosePair& pose : poses) {
    const double off_m = (pose::to_world(out.transform, pose.tracked_m) - pose.device_m).norm();
    out.residual_m.push_back(off_m);
    sum_m2 += off_m * off_m;
  }
  out.rms_m = std::sqrt(sum_m2 / static_cast<double>(poses.size()));
  out.largest_m = std::ranges::max(out.residual_m);
  return out;
}

void PoseCollector::begin(double now_s, const Vector3d& device_m) {
  is_still_ = true;
  still_since_s_ = now_s;
  began_at_m_ = device_m;
  sum_ = {};
  count_ = 0;
}

bool PoseCollector::add(double now_s, const Vector3d& device_m, double speed_mps,
                        const std::optional<Vector3d>& tracked_m) {
  // Telemetry is faster than the tracker: equal numbers are one observation.
  const bool is_new_sample = tracked_m != last_tracked_m_;
  last_tracked_m_ = tracked_m;
  if (!(speed_mps < kStill_mps) || !tracked_m) {
    is_still_ = false;
    return false;
  }
  // A slow drift stays below kStill_mps, so the distance is checked, too.
  if (!is_still_ || !((device_m - began_at_m_).norm() <= kRestTolerance_m)) begin(now_s, device_m);
  if (now_s - still_since_s_ < kSettle_s || !is_new_sample) return false;
  sum_.tracked_m += *tracked_m;
  sum_.device_m += device_m;
  ++count_;
  if (now_s - still_since_s_ < kSettle_s + kAverage_s || count_ < kLooks) return false;
  const double n = static_cast<double>(count_);
  const PosePair mean{.tracked_m = sum_.tracked_m / n, .device_m = sum_.device_m / n};
  // Many poses of one place would dominate the fit.
  const bool is_new = std::ranges::all_of(poses_, [&](const PosePair& pose) {
    return (pose.device_m - mean.device_m).norm() >= kApart_m;
  });
  if (is_new) poses_.push_back(mean);
  is_still_ = false;
  return is_new;
}

std::optional<Error> write_registration(const std::string& path, const Registration& registration) {
  const Eigen::Quaterniond& q = registration.transform.rotation;
  const Vector3d& p = registration.transform.position_m;
  const std::string text = fmt::format(
      "# tracker's frame -> device's frame, by tact-view --register from {} poses:\n"
      "# residuals {:.2f} mm rms, {:.2f} mm at most\n[registration]\n"
      "position_m = [{}, {}, {}]\nrotation_wxyz = [{}, {}, {}, {}]\n",
      registration.residual_m.size(), 1e3 * registration.rms_m, 1e3 * registration.largest_m,
      // TOML wants a point: 0.0, not 0
      fmt::format("{:.9f}", p.x()), fmt::format("{:.9f}", p.y()), fmt::format("{:.9f}", p.z()),
      fmt::format("{:.12f}", q.w()), fmt::format("{:.12f}", q.x()), fmt::format("{:.12f}", q.y()),
      fmt::format("{:.12f}", q.z()));
  std::error_code failed;
  // Keeps the previous file: a bad registration is noticed only later, by the figure's position.
  if (fs::exists(path, failed)) {
    const auto before = model::io::read_file(path, "check who may read it");
    if (!before) return before.error();
    if (auto error = model::io::write_file(path + ".bak", *before)) return error;
  }
  return model::io::write_file(path, text);
}

}  // namespace tact::host::tracking
