// SPDX-License-Identifier: Apache-2.0
// tracking_views.h - marker bodies, cameras and what these see of them, made up for tests.
#pragma once

#include <fmt/format.h>

#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "host/tracking/operator_tracker.h"

namespace tact::test {

using host::pose::Pose;
using host::tracking::Observation;

inline Eigen::Quaterniond turn(double angle_rad, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis.normalized()));
}

/// Eight markers in a body of 15 cm, not in a plane.
inline std::vector<host::tracking::BodyMarker> eight_markers() {
  const double at_m[8][3] = {{.06, .03, .02},    {-.05, .04, .03}, {.02, -.06, .04},
                             {-.03, -.05, -.04}, {.05, .05, -.03}, {-.06, .01, -.02},
                             {.01, .02, .07},    {.03, -.02, -.06}};
  std::vector<host::tracking::BodyMarker> out;
  for (std::uint32_t i = 0; i < 8; ++i)
    out.push_back({.id = i, .position_m = {at_m[i][0], at_m[i][1], at_m[i][2]}});
  return out;
}

inline host::tracking::TrackingCamera camera(const std::string& name,
                                             const std::optional<Pose>& pose) {
  return {.name = name,
          .lens = {.fx_px = 1200.0, .fy_px = 1200.0, .cx_px = 960.0, .cy_px = 540.0},
          .pose = pose};
}

/// Camera "front" at the tracker's origin sees the body "hand" there and, if asked, more.
inline host::tracking::TrackingSetup setup_of(
    std::vector<host::tracking::TrackingCamera> cameras,
    std::vector<std::pair<std::string, std::optional<host::tracking::BodyRole>>> bodies) {
  host::tracking::TrackingSetup out;
  out.path = "made-up.tracking.toml";
  out.udp_port = 1;
  out.cameras = std::move(cameras);
  for (const auto& [name, role] : bodies)
    out.bodies.push_back({.name = name, .role = role, .markers = eight_markers(), .tip_m = {}});
  return out;
}

/// What a camera at `eye` (its axes to the tracker's) sees of a body at `body` (to the tracker's).
inline Observation look(const host::tracking::TrackingCamera& camera, const Pose& eye,
                        const std::string& name, const Pose& body, double time_s,
                        std::uint64_t sequence, std::mt19937* noise = nullptr,
                        double noise_px = 0.5) {
  Observation out{
      .time_s = time_s, .sequence = sequence, .camera = camera.name, .body = name, .points = {}};
  std::normal_distribution<double> normal(0.0, noise_px);
  const Pose seen = host::pose::bind(eye, body);  // camera <- body
  for (const host::tracking::BodyMarker& marker : eight_markers()) {
    const Eigen::Vector3d x = to_world(seen, marker.position_m);
    Eigen::Vector2d px(camera.lens.fx_px * x.x() / x.z() + camera.lens.cx_px,
                       camera.lens.fy_px * x.y() / x.z() + camera.lens.cy_px);
    if (noise != nullptr) px += Eigen::Vector2d(normal(*noise), normal(*noise));
    out.points.push_back({.id = marker.id, .pixel_px = px});
  }
  return out;
}

/// A camera `distance_m` from a place, which it looks at along `ahead` (unit), rolled at will.
inline Pose eye_towards(const Eigen::Vector3d& place_m, const Eigen::Vector3d& ahead,
                        double distance_m, double roll_rad = 0.0) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ(), axis = z.cross(ahead);
  const Eigen::Quaterniond towards = turn(std::atan2(axis.norm(), z.dot(ahead)), axis);
  return {.rotation = towards * turn(roll_rad, z), .position_m = place_m - distance_m * ahead};
}

/// The observation as its line.
inline std::string line_of(const Observation& seen) {
  std::string points;
  for (const host::tracking::SeenMarker& p : seen.points) {
    points += fmt::format("{}[{},{:.6f},{:.6f}]", points.empty() ? "" : ",", p.id, p.pixel_px.x(),
                          p.pixel_px.y());
  }
  return fmt::format(R"({{"time_s":{:.6f},"sequence":{},"camera":"{}","body":"{}","points":[{}]}})",
                     seen.time_s, seen.sequence, seen.camera, seen.body, points);
}

inline void write_file(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A description with camera "front" at the tracker's origin and the eight markers for each body.
inline std::string description(const std::string& input,
                               const std::vector<std::pair<std::string, std::string>>& bodies,
                               const std::string& more = {}) {
  std::string markers;
  for (const host::tracking::BodyMarker& m : eight_markers()) {
    markers += fmt::format("[{}, {}, {}, {}], ", m.id, m.position_m.x(), m.position_m.y(),
                           m.position_m.z());
  }
  std::string out = fmt::format(
      "[input]\n{}\n[[camera]]\nname = \"front\"\nfx_px = 1200.0\nfy_px = 1200.0\ncx_px = "
      "960.0\ncy_px = 540.0\nposition_m = [0.0, 0.0, 0.0]\nrotation_wxyz = [1.0, 0.0, 0.0, 0.0]\n",
      input);
  for (const auto& [name, role] : bodies) {
    out += fmt::format("[[body]]\nname = \"{}\"\nrole = \"{}\"\nmarkers_m = [{}]\n", name, role,
                       markers);
    if (role == "tool") out += "tip_m = [0.1, 0.0, 0.0]\n";
  }
  return out + more;
}

}  // namespace tact::test
