// SPDX-License-Identifier: Apache-2.0
// operator_tracker.h - observations in, the operator's bodies in the device's frame out.
//
//     pose = registration * camera * (camera <- body)       each a Pose: rotation, then position
//
//     registration  tracker's frame to the device's     camera  camera's axes to the tracker's
//     camera <- body  from the markers (robust_pose.h)
//
// Looks of other cameras at the same body, at most kTogether_s before or after, are solved with it
// (joint_pose.h), one camera after the other. Only such count whose pose was believed, that do not
// repeat themselves, and whose camera's place is known. Views that contradict each other are not
// joined: the newest counts alone.
//
// A camera whose place is not written down is found from the base: the inverse of (camera <- base),
// filtered; the last one stands while the base is hidden. Pure: time is an argument.
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

  /// Error: why the observation belongs to nothing here. `now_s` of the viewer's clock.
  std::optional<model::Error> take(const Observation& seen, double now_s);
  /// Every body as it is at `now_s`.
  TrackedOperator at(double now_s) const;

  const TrackingSetup& setup() const { return setup_; }

 private:
  struct Look {
    double time_s = 0.0;
    pose::BodyView view;
  };
  struct Joint {
    pose::PoseEstimate estimate;  // tracker <- body
    double time_s = 0.0;          // of the newest look in it
  };
  std::optional<Pose> camera_pose(std::size_t camera) const;
  /// With the looks of the other cameras; none if there is none to join.
  std::optional<Joint> join(std::size_t body, std::size_t camera, const Look& look) const;
  void take(std::size_t body, std::size_t camera, Look look, pose::PoseEstimate estimate,
            double now_s);

  TrackingSetup setup_;
  std::vector<BodyTracker> trackers_;                    // by body
  std::vector<std::vector<std::optional<Look>>> looks_;  // by body and camera: the last good one
  std::vector<BodyTracker> places_;                      // of the cameras, from the base
};

}  // namespace tact::host::tracking
