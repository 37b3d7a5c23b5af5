// SPDX-License-Identifier: Apache-2.0
// tracking_setup.h - the tracker's description: its cameras, marker bodies and pose.
// SCENE.tracking.toml, described in README.md.
//
// Set-up code only.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/pose/pose_polish.h"
#include "host/tracking/tracked_operator.h"
#include "model/result.h"

namespace tact::host::tracking {

struct TrackingCamera {
  std::string name;
  pose::Camera lens{};
  double outlier_px = 3.0;   // a marker farther than this from its computed pixel is an outlier
  std::optional<Pose> pose;  // camera's axes to the tracker's; none: computed from the base
};

struct BodyMarker {
  std::uint32_t id = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // in the body's axes
};

struct MarkerBody {
  std::string name;
  std::optional<BodyRole> role;  // none: the base, whose axes are the tracker's frame
  std::vector<BodyMarker> markers;
  std::optional<Eigen::Vector3d> tip_m;  // of a tool: the point whose position the device measures
};

struct TrackingSetup {
  std::string path;
  std::uint16_t udp_port = 0;  // 0: `recording` is played
  std::string recording;
  std::vector<TrackingCamera> cameras;
  std::vector<MarkerBody> bodies;
  std::optional<Eigen::Vector3d> shoulder_m;  // of the operator, right, device's frame
  Pose registration{};                        // tracker's frame to the device's
  std::string registered_by;  // the file with the registration; empty: none, it is the identity

  const MarkerBody* body_of(BodyRole role) const;
};

/// The error is one line with the cause, its position (file:line) and the remedy.
model::Result<TrackingSetup> load_tracking_setup(const std::string& path);

/// SCENE.registration.toml in the folder of SCENE.tracking.toml.
std::string registration_path(const std::string& tracking_path);

/// The role as in the description, such as "left_leg".
const char* name_of(BodyRole role);

}  // namespace tact::host::tracking
