// SPDX-License-Identifier: Apache-2.0
// igtl_bodies.h - poses by the name of their device in, the operator's bodies out.
//
// The name is that of a role, alone or as PLUS writes it: "head", "LeftLegToDevice". A pose is in
// frame W. It is judged as one of a camera is (host/tracking/body_tracker.h): out of order, frozen,
// jumps, silent. For display; no force depends on it. Pure: time is an argument.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "host/tracking/body_tracker.h"
#include "host/tracking/tracked_operator.h"
#include "model/result.h"

namespace tact::host::igtl {

/// "LeftLegToDevice" is left_leg; none: the name is that of no body.
std::optional<tracking::BodyRole> role_of(std::string_view device);

class IgtlBodies {
 public:
  /// `sent_s` of the sender's clock, 0 without one; `now_s` of the viewer's. A sender that gives
  /// another pose the same time has no clock.
  void take(tracking::BodyRole role, const pose::Pose& pose, double sent_s, double now_s);
  /// Bodies that never came are absent.
  tracking::TrackedOperator at(double now_s) const;

 private:
  struct Body {
    tracking::BodyTracker tracker{1};
    std::uint64_t looks = 0;
    double sent_s = 0.0;  // of the last pose
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
    bool has_clock = true;
  };
  std::array<std::optional<Body>, tracking::kBodyRoles> bodies_;
};

/// The bodies of both; a body that `first` does not know is that of `second`.
tracking::TrackedOperator joined(const tracking::TrackedOperator& first,
                                 const tracking::TrackedOperator& second);

}  // namespace tact::host::igtl
