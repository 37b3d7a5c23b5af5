// SPDX-License-Identifier: Apache-2.0
// registration.h - the pose of the tracker: the rigid motion from the tracker's frame to the
// device's that maps points of the tracked tool onto the device's own.
//
//     minimise  sum |R q_i + t - p_i|^2        by Umeyama's fit [1], det R = +1, no scale
//     rms^2 = (1/n) sum |R q_i + t - p_i|^2
//
//     q_i  tip of the tracked tool in the tracker's frame, m     p_i  tool of the device in W, m
//
// Refused: fewer than kMinPoses, and poses on a line, whose spread across the line (root of the
// second eigenvalue of their covariance) is below kMinSpread_m: the rotation about the line is then
// unknown. A plane is enough.
//
// [1] S. Umeyama, IEEE Trans. Pattern Analysis and Machine Intelligence 13 (1991) 376-380. By
// Eigen.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/pose/coordinate_chain.h"
#include "model/result.h"

namespace tact::host::tracking {

using pose::Pose;

inline constexpr std::size_t kMinPoses = 6;
inline constexpr double kMinSpread_m = 0.005;
inline constexpr double kDoubtful_m = 0.002;  // larger residuals give a warning

struct PosePair {
  Eigen::Vector3d tracked_m = Eigen::Vector3d::Zero();  // q_i
  Eigen::Vector3d device_m = Eigen::Vector3d::Zero();   // p_i
};

struct Registration {
  Pose transform{};                // tracker's frame to the device's
  std::vector<double> residual_m;  // of each pose
  double rms_m = 0.0, largest_m = 0.0;
};

/// The error states the cause and the remedy.
model::Result<Registration> fit_registration(std::span<const PosePair> poses);

/// Records a pose whenever the tool rests at a new place.
class PoseCollector {
 public:
  static constexpr double kStill_mps = 0.005;
  static constexpr double kSettle_s = 0.2;   // discarded: the tracker lags behind
  static constexpr double kAverage_s = 1.5;  // averaged after that, at least
  static constexpr std::size_t kLooks = 40;  // observations, at least: 3 mm of noise become 0.5
  static constexpr double kRestTolerance_m = 0.001;  // a larger distance from the start is not rest
  static constexpr double kApart_m = 0.015;

  /// One frame of telemetry; `tracked_m` if the tracker sees the tool now. Equal numbers in
  /// succession are one observation. True if a pose was recorded: the means of both sides after the
  /// tool had settled. After a mean, recorded or not, the next one starts.
  bool add(double now_s, const Eigen::Vector3d& device_m, double speed_mps,
           const std::optional<Eigen::Vector3d>& tracked_m);
  const std::vector<PosePair>& poses() const { return poses_; }

 private:
  void begin(double now_s, const Eigen::Vector3d& device_m);

  std::vector<PosePair> poses_;
  PosePair sum_;
  std::size_t count_ = 0;
  double still_since_s_ = 0.0;
  Eigen::Vector3d began_at_m_ = Eigen::Vector3d::Zero();  // device's position at the start of rest
  bool is_still_ = false;
  std::optional<Eigen::Vector3d> last_tracked_m_;
};

/// Writes `path` as SCENE.registration.toml, completely or not at all; an existing file becomes
/// path.bak. The error states the cause.
std::optional<model::Error> write_registration(const std::string& path,
                                               const Registration& registration);

}  // namespace tact::host::tracking
