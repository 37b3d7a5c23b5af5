// SPDX-License-Identifier: Apache-2.0
#include "host/pose/joint_pose.h"

#include <algorithm>

namespace tact::host::pose {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A camera displaced by 10 cm can shift the pixels of a body of 15 cm at 2 m by only two pixels, if
// the other camera takes it for depth: the outlier limit of 3 px alone would accept that.
constexpr double kAgree_ratio = 1.0 / 3.0, kWorse_ratio = 2.0;
// Tangents compare between cameras of different focal length; pixels do not.
constexpr Camera kTangents{.fx_px = 1.0, .fy_px = 1.0};

std::vector<MarkerView> marker_views(std::span<const BodyView> views) {
  std::vector<MarkerView> out;
  out.reserve(views.size());
  for (const BodyView& view : views) {
    out.push_back({.camera = kTangents,
                   .eye = view.eye,
                   .points_m = view.points_m,
                   .pixels_px = view.tangents});
  }
  return out;
}

/// The poses of the single views, ordered by how well they explain all views.
std::vector<Pose> starts_of(std::span<const BodyView> views, std::span<const MarkerView> markers) {
  std::vector<std::pair<double, Pose>> starts;
  starts.reserve(views.size());
  for (const BodyView& view : views) {
    const Pose start = drive(view.eye, view.alone);
    starts.emplace_back(reprojection_rms_px(markers, start), start);
  }
  std::ranges::stable_sort(starts, {}, &std::pair<double, Pose>::first);
  std::vector<Pose> out;
  out.reserve(starts.size());
  for (const auto& [rms, start] : starts) out.push_back(start);
  return out;
}

}  // namespace

BodyView body_view(const Camera& camera, std::span<const Vector3d> points_m,
                   std::span<const Vector2d> pixels_px, double outlier_px, const Pose& alone) {
  BodyView out;
  out.alone = alone;
  out.focal_px = 0.5 * (camera.fx_px + camera.fy_px);
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const double off_px =
        reprojection_rms_px(camera, points_m.subspan(i, 1), pixels_px.subspan(i, 1), alone);
    // An outlier of this view would distort the joint pose, too.
    if (!(off_px <= outlier_px)) continue;
    out.points_m.push_back(points_m[i]);
    out.tangents.emplace_back((pixels_px[i].x() - camera.cx_px) / camera.fx_px,
                              (pixels_px[i].y() - camera.cy_px) / camera.fy_px);
  }
  const MarkerView kept{.camera = kTangents, .points_m = out.points_m, .pixels_px = out.tangents};
  const double outlier_tan = outlier_px / out.focal_px;
  const double alone_tan = reprojection_rms_px({&kept, 1}, alone);
  out.limit_tan =
      std::min(outlier_tan, std::max(kAgree_ratio * outlier_tan, kWorse_ratio * alone_tan));
  return out;
}

PoseEstimate joint_pose(std::span<const BodyView> views) {
  if (views.empty()) return {};
  const std::vector<MarkerView> markers = marker_views(views);
  // One start usually suffices; a mirrored one (epnp.h) converges to a pose that the other views
  // contradict.
  for (const Pose& start : starts_of(views, markers)) {
    const Pose pose = polish_pose(markers, start);
    bool agree = true;
    for (std::size_t i = 0; i < views.size(); ++i)
      agree = agree && reprojection_rms_px({&markers[i], 1}, pose) <= views[i].limit_tan;
    if (!agree) continue;
    return {.status = PoseStatus::kOk,
            .pose = {.rotation = canonical(pose.rotation), .position_m = pose.position_m},
            .rms_px = views.front().focal_px * reprojection_rms_px(markers, pose)};
  }
  return {.status = PoseStatus::kNoPose};
}

}  // namespace tact::host::pose
