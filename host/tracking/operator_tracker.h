// SPDX-License-Identifier: Apache-2.0
// operator_tracker.h - computes the operator's bodies in the device's frame from observations.
//
//     pose = registration * camera * (camera <- body)       each a Pose: rotation, then position
//
//     registration  tracker's frame to the device's     camera  camera's axes to the tracker's
//     camera <- body  from the markers (robust_pose.h)
//
// Observations of other cameras of the same body, at most kTogether_s before or after, are solved
// with it (joint_pose.h), one camera after the other. Used are only cameras whose pose is known,
// whose last body pose was accepted and whose numbers do not repeat. If views contradict each
// other, only the newest is used.
//
// The pose of a camera that the description omits is the inverse of (camera <- base), filtered; the
// last one is kept while the base is hidden. Pure: time is an argument.
#pragma once

#include <optional>
#include <vector>

#include "host/pose/joint_pose.h"
#include "host/tracking/body_tracker.h"
#include "host/tracking/tracking_setup.h"
#include "model/result.h"

namespace tact::host::tracking {

class OperatorTracker {
 public:
  explicit OperatorTracker(TrackingSetup setup);

  /// The error says why the observation fits nothing here. `now_s` of the viewer's clock.
  std::optional<model::Error> take(const Observation& seen, double now_s);
  /// All bodies at `now_s`.
  TrackedOperator at(double now_s) const;

  const TrackingSetup& setup() const { return setup_; }

 private:
  struct CameraView {
    double time_s = 0.0;
    pose::BodyView body;
  };
  struct Joint {
    pose::PoseEstimate estimate;  // tracker <- body
    double time_s = 0.0;          // of the newest observation in it
  };
  std::optional<Pose> camera_pose(std::size_t camera) const;
  /// Solves together with the observations of the other cameras; none if there are none.
  std::optional<Joint> join(std::size_t body, std::size_t camera, const CameraView& view) const;
  void take(std::size_t body, std::size_t camera, CameraView view, pose::PoseEstimate estimate,
            double now_s);

  TrackingSetup setup_;
  std::vector<BodyTracker> trackers_;  // by body
  std::vector<std::vector<std::optional<CameraView>>>
      views_;                        // by body and camera: the last good one
  std::vector<BodyTracker> places_;  // poses of the cameras, from the base
};

}  // namespace tact::host::tracking
