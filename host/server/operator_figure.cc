// SPDX-License-Identifier: Apache-2.0
#include "host/server/operator_figure.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "host/figure/figure_json.h"

namespace tact::host::server {
namespace {

pose::Pose pose_of(const record::Frame& frame) {
  const float (&p)[3] = frame.tool_position_m;
  const float (&q)[4] = frame.tool_orientation;
  // An invalid rotation becomes the zero quaternion: the figure then keeps the tool's last pose.
  const auto turn = pose::rotation_from({static_cast<double>(q[0]), static_cast<double>(q[1]),
                                         static_cast<double>(q[2]), static_cast<double>(q[3])});
  return {.rotation = turn ? *turn : Eigen::Quaterniond(0.0, 0.0, 0.0, 0.0),
          .position_m = Eigen::Vector3f(p[0], p[1], p[2]).cast<double>()};
}

}  // namespace

Eigen::Vector3d grip_of(const record::RunHeader& header, const record::MeshBytes& mesh) {
  // After the organ's vertices and triangles, 12 bytes each (telemetry_check.h).
  const std::size_t at = 12 * (std::size_t{header.organ_vertices} + header.organ_triangles);
  const std::size_t bytes = 12 * std::size_t{header.tool_vertices};
  if (bytes == 0 || mesh.size() < at + bytes) return figure::FigureSettings{}.grip_m;
  double top_m = 0.0;
  for (std::size_t i = 0; i < bytes; i += 12) {
    float z_m = 0.0f;
    // z is the third float of a vertex; the tool's handle points along +z (figure.h).
    std::memcpy(&z_m, mesh.data() + at + i + 8, sizeof z_m);
    top_m = std::max(top_m, static_cast<double>(z_m));
  }
  return figure::grip_m(top_m);
}

OperatorFigure::OperatorFigure(double height_m)
    : settings_({.height_m = height_m}), figure_(settings_) {}

void OperatorFigure::put_shoulder_at(const Eigen::Vector3d& shoulder_m) {
  settings_.shoulder_m = shoulder_m;
  figure_ = figure::Figure(settings_);
}

nlohmann::json OperatorFigure::begin(const record::RunHeader& header,
                                     const record::MeshBytes& mesh) {
  settings_.grip_m = grip_of(header, mesh);
  figure_.go_on_with(settings_.grip_m);
  return skeleton_json(figure_.plan());
}

std::string OperatorFigure::with(const record::Frame& frame,
                                 const tracking::TrackedOperator* tracked,
                                 const figure::FigurePose* shown) {
  static const tracking::TrackedOperator kNone{};
  const double time_s = static_cast<double>(frame.time_ns) * 1e-9;
  // A recording's figure is shown as recorded, not posed again.
  reported_ = shown ? *shown : figure_.update(time_s, pose_of(frame), tracked ? *tracked : kNone);
  const bool head_tracked =
      tracked && (*tracked)[tracking::BodyRole::kHead].state == tracking::BodyState::kTracked;
  return figure_json(reported_, frame.tick, head_tracked);
}

}  // namespace tact::host::server
