// SPDX-License-Identifier: Apache-2.0
// operator_motion.h - thirty seconds of a made-up operator: the tool works, the body sways,
// trackers fall silent, freeze and jump. Own work; every number is chosen, none is measured.
#pragma once

#include <cmath>

#include "host/tracking/tracked_operator.h"
#include "tests/support/tool_motion.h"

namespace tact::test {

/// A body that sways about `home` by `sway_m` and turns a little.
inline host::tracking::TrackedBody sways(const Eigen::Vector3d& home_m, double sway_m, double t_s) {
  host::tracking::TrackedBody body{.state = host::tracking::BodyState::kTracked};
  body.pose.position_m =
      home_m + sway_m * Eigen::Vector3d(std::sin(0.8 * t_s), std::sin(0.5 * t_s + 0.4),
                                        0.4 * std::sin(1.1 * t_s));
  body.pose.rotation = Eigen::AngleAxisd(0.3 * std::sin(0.6 * t_s), Eigen::Vector3d::UnitZ()) *
                       Eigen::AngleAxisd(0.2 * std::sin(0.9 * t_s), Eigen::Vector3d::UnitY());
  return body;
}

/// The bodies of an operator of 1.75 m, all seen all the time.
inline host::tracking::TrackedOperator bodies_at(double t_s) {
  using host::tracking::BodyRole;
  host::tracking::TrackedOperator out;
  out.time_s = t_s;
  out[BodyRole::kHead] = sways({0.40, -0.08, 0.56}, 0.06, t_s);
  out[BodyRole::kShoulder] = sways({0.42, 0.12, 0.37}, 0.04, t_s);
  out[BodyRole::kWaist] = sways({0.42, -0.08, -0.13}, 0.03, t_s);
  out[BodyRole::kHand] = sways({0.10, 0.05, 0.10}, 0.03, t_s);
  out[BodyRole::kLeftLeg] = sways({0.35, -0.20, -0.55}, 0.02, t_s);
  out[BodyRole::kRightLeg] = sways({0.35, 0.05, -0.55}, 0.02, t_s);
  out[BodyRole::kLeftAnkle] = sways({0.42, -0.20, -0.98}, 0.02, t_s);
  out[BodyRole::kRightAnkle] = sways({0.42, 0.05, -0.98}, 0.01, t_s);
  out[BodyRole::kLeftHand] = sways({0.10, -0.30, 0.02}, 0.05, t_s);
  out[BodyRole::kElbow] = sways({0.42, 0.28, 0.06}, 0.03, t_s);
  return out;
}

/// The same with trouble: head silent, shoulder frozen, waist jumps for good, hands come and go,
/// and the elbow is lost.
inline host::tracking::TrackedOperator troubled_bodies_at(double t_s) {
  using host::tracking::BodyRole;
  using host::tracking::BodyState;
  host::tracking::TrackedOperator out = bodies_at(t_s);
  const auto lose = [&](BodyRole role, double from_s, double to_s,
                        host::tracking::TrackingTrouble why) {
    if (t_s < from_s + host::tracking::kHold_s || t_s >= to_s) return;
    const bool lost = t_s >= from_s + host::tracking::kLose_s;
    out[role].state = lost ? BodyState::kLost : BodyState::kHeld;
    out[role].trouble = why;
    out[role].pose = bodies_at(from_s)[role].pose;
  };
  lose(BodyRole::kHead, 5.0, 9.0, host::tracking::TrackingTrouble::kSilent);
  lose(BodyRole::kShoulder, 12.0, 15.0, host::tracking::TrackingTrouble::kFrozen);
  if (t_s > 17.0) out[BodyRole::kWaist].pose.position_m += Eigen::Vector3d(0.06, -0.10, 0.0);
  lose(BodyRole::kElbow, 10.0, 16.0, host::tracking::TrackingTrouble::kNoPose);
  for (double at_s = 18.0; at_s < 24.0; at_s += 0.9) {
    lose(BodyRole::kHand, at_s, at_s + 0.7, host::tracking::TrackingTrouble::kTooFewPoints);
    lose(BodyRole::kLeftHand, at_s, at_s + 0.6, host::tracking::TrackingTrouble::kSilent);
    lose(BodyRole::kLeftAnkle, at_s, at_s + 0.3, host::tracking::TrackingTrouble::kOutOfOrder);
  }
  return out;
}

}  // namespace tact::test
