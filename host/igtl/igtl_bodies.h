// SPDX-License-Identifier: Apache-2.0
// igtl_bodies.h - the operator's bodies from poses that are identified by their device name.
//
// The name is that of a role, alone or as PLUS writes it: "head", "LeftLegToDevice". A pose is in
// frame W. It is checked like that of a camera (host/tracking/body_tracker.h): out of order,
// frozen, jump, silent. For display; no force depends on it. Pure: time is an argument.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "host/tracking/body_tracker.h"
#include "host/tracking/tracked_operator.h"
#include "model/result.h"

namespace tact::host::igtl {

/// "LeftLegToDevice" gives left_leg; none: not the name of a body.
std::optional<tracking::BodyRole> role_of(std::string_view device);

class IgtlBodies {
 public:
  /// `sent_s` of the sender's clock, 0 without one; `now_s` of the viewer's. If another pose has
  /// the same `sent_s`, the sender's time is no longer used.
  void take(tracking::BodyRole role, const pose::Pose& pose, double sent_s, double now_s);
  /// Bodies that were never received are absent.
  tracking::TrackedOperator at(double now_s) const;

 private:
  struct Body {
    tracking::BodyTracker tracker{1};
    std::uint64_t samples = 0;
    double sent_s = 0.0;  // of the last pose
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
    bool has_clock = true;
  };
  std::array<std::optional<Body>, tracking::kBodyRoles> bodies_;
};

/// The bodies of both; those absent in `first` are taken from `second`.
tracking::TrackedOperator joined(const tracking::TrackedOperator& first,
                                 const tracking::TrackedOperator& second);

}  // namespace tact::host::igtl
