// SPDX-License-Identifier: Apache-2.0
#include "host/tracking/operator_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/pose/robust_pose.h"

namespace tact::host::tracking {
namespace {

using model::Error;

Pose inverse(const Pose& pose) { return pose::bind(pose, Pose{}); }

/// The markers of the body that the camera sees.
pose::Markers markers_of(const MarkerBody& body, const Observation& seen) {
  pose::Markers out;
  for (const SeenMarker& point : seen.points) {
    const auto marker = std::ranges::find(body.markers, point.id, &BodyMarker::id);
    if (marker == body.markers.end()) continue;
    out.points_m.push_back(marker->position_m);
    out.pixels_px.push_back(point.pixel_px);
  }
  return out;
}

}  // namespace

OperatorTracker::OperatorTracker(TrackingSetup setup)
    : setup_(std::move(setup)),
      trackers_(setup_.bodies.size(), BodyTracker(setup_.cameras.size())),
      views_(setup_.bodies.size(), std::vector<std::optional<CameraView>>(setup_.cameras.size())),
      places_(setup_.cameras.size(), BodyTracker(1)) {}

std::optional<Pose> OperatorTracker::camera_pose(std::size_t camera) const {
  if (setup_.cameras[camera].pose) return setup_.cameras[camera].pose;
  return places_[camera].last_pose();
}

std::optional<OperatorTracker::Joint> OperatorTracker::join(std::size_t body, std::size_t camera,
                                                            const CameraView& view) const {
  std::vector<pose::BodyView> views{view.body};
  std::optional<Joint> out;
  for (std::size_t other = 0; other < setup_.cameras.size(); ++other) {
    const std::optional<CameraView>& other_view = views_[body][other];
    if (other == camera || !other_view) continue;
    // Earlier or later, because datagrams of two cameras arrive in any order.
    if (!(std::abs(other_view->time_s - view.time_s) <= kTogether_s)) continue;
    views.push_back(other_view->body);
    const pose::PoseEstimate joint = pose::joint_pose(views);
    if (joint.status != pose::PoseStatus::kOk) {
      views.pop_back();  // it contradicts the newest view
      continue;
    }
    out = {.estimate = joint,
           .time_s = std::max(out ? out->time_s : view.time_s, other_view->time_s)};
  }
  return out;
}

void OperatorTracker::take(std::size_t body, std::size_t camera, CameraView view,
                           pose::PoseEstimate estimate, double now_s) {
  const auto registered = [&](pose::PoseEstimate e) {
    e.pose = pose::drive(setup_.registration, e.pose);
    return e;
  };
  BodyTracker& tracker = trackers_[body];
  // From the camera's axes to the tracker's.
  estimate.pose = pose::drive(view.body.eye, estimate.pose);
  // A repeated image would hold a joint pose at the body's old position.
  const bool enters = !tracker.repeats(camera);
  const std::optional<Joint> joint = enters ? join(body, camera, view) : std::nullopt;
  bool good = tracker.take(registered(joint ? joint->estimate : estimate), view.time_s, now_s);
  // Not newer than the good pose, but of its moment: refines it without advancing the filter.
  if (!good && joint) good = tracker.refine(registered(joint->estimate), joint->time_s);
  // A rejected observation must not be joined with a later one of another camera.
  views_[body][camera].reset();
  if (good && enters) views_[body][camera] = std::move(view);
}

std::optional<Error> OperatorTracker::take(const Observation& seen, double now_s) {
  const auto camera = std::ranges::find(setup_.cameras, seen.camera, &TrackingCamera::name);
  if (camera == setup_.cameras.end())
    return Error{fmt::format("camera {} is not in {}; add it there", seen.camera, setup_.path)};
  const auto body = std::ranges::find(setup_.bodies, seen.body, &MarkerBody::name);
  if (body == setup_.bodies.end())
    return Error{fmt::format("body {} is not in {}; add it there", seen.body, setup_.path)};
  const auto camera_at = static_cast<std::size_t>(camera - setup_.cameras.begin());
  const bool is_base = !body->role;
  if (is_base && camera->pose) return std::nullopt;  // the description has the camera's pose
  const auto body_at = static_cast<std::size_t>(body - setup_.bodies.begin());
  BodyTracker& tracker = is_base ? places_[camera_at] : trackers_[body_at];
  if (!tracker.admit(is_base ? 0 : camera_at, sample_of(seen), now_s)) return std::nullopt;
  const pose::Markers markers = markers_of(*body, seen);
  pose::PoseEstimate estimate =
      pose::robust_pose(camera->lens, markers.points_m, markers.pixels_px, camera->outlier_px);
  const std::optional<Pose> place = camera_pose(camera_at);
  if (is_base) {
    // The base is the tracker's frame, so the inverse of (camera <- base) is the camera's pose.
    estimate.pose = inverse(estimate.pose);
  } else if (estimate.status == pose::PoseStatus::kOk && place) {
    CameraView view{.time_s = seen.time_s,
                    .body = pose::body_view(camera->lens, markers.points_m, markers.pixels_px,
                                            camera->outlier_px, estimate.pose)};
    view.body.eye = *place;
    take(body_at, camera_at, std::move(view), estimate, now_s);
    return std::nullopt;
  } else if (estimate.status == pose::PoseStatus::kOk) {
    estimate.status = pose::PoseStatus::kNoPose;  // the base has not been seen yet
  }
  tracker.take(estimate, seen.time_s, now_s);
  return std::nullopt;
}

TrackedOperator OperatorTracker::at(double now_s) const {
  TrackedOperator out{.time_s = now_s};
  for (std::size_t i = 0; i < setup_.bodies.size(); ++i)
    if (const auto role = setup_.bodies[i].role) out[*role] = trackers_[i].at(now_s);
  return out;
}

}  // namespace tact::host::tracking
