// SPDX-License-Identifier: Apache-2.0
// seen_operator.h - an operator at work as two cameras see him: markers, noise, hidden points.
//
//     motion    motion.cc: where head, shoulder, waist and hand are at a time
//     cameras   view.cc: what of it comes out as pixels, with what goes wrong
//
// Everything is a formula and a seeded draw: the same bytes on every run. The operator stands at +x
// of W (+x towards him, +y to his right, +z up), looks towards -x and works at the origin. The
// tracker's frame has y up, as many trackers do, and stands beside the table.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/pose/coordinate_chain.h"
#include "host/pose/pose_polish.h"

namespace tact::tools::make_tracking {

inline constexpr double kLength_s = 30.0;
inline constexpr double kFrames_Hz = 30.0;  // the two cameras take turns ...
inline constexpr double kApart_s = 0.008;   // ... in pairs: the front, so long after it the side
inline constexpr int kFrames = 900;
inline constexpr double kNoise_px = 0.5;

struct TrackedBody {
  const char* name;                       // of the body and of its role
  std::vector<Eigen::Vector3d> marker_m;  // in the body's axes; its id is the place in the list
  int every = 1, first = 0;               // seen in frames first, first + every, ...
};

struct TrackingCamera {
  const char* name;
  host::pose::Camera lens;
  host::pose::Pose pose;  // of the camera in W: looks along its +Z, +X right, +Y down
};

/// Tracker's frame to W.
host::pose::Pose registration();

std::span<const TrackedBody> tracked_bodies();
std::span<const TrackingCamera> tracking_cameras();

/// Of the body in W; periodic in kLength_s.
host::pose::Pose body_pose(const TrackedBody& body, double time_s);

struct SeenPoint {
  int id = 0;
  Eigen::Vector2d pixel_px;
};

struct Sight {
  double time_s = 0.0;
  int sequence = 0;  // of the camera
  const TrackingCamera* camera = nullptr;
  const TrackedBody* body = nullptr;
  std::vector<SeenPoint> points;
};

/// All of the recording, in the order of its lines.
std::vector<Sight> look();

}  // namespace tact::tools::make_tracking
