// SPDX-License-Identifier: Apache-2.0
// tracked_operator.h - the tracked operator: one pose per body, in the device's frame W (+x towards
// the operator, +y to the right, +z up).
//
//     kTracked   a good pose, newer than kHold_s
//     kHeld      none for kHold_s: the last good pose is kept
//     kLost      none for kLose_s, or never one: the pose is meaningless
//
// For display. Only the viewer's thread writes and reads it; no force depends on it.
#pragma once

#include <array>
#include <cstdint>

#include "host/pose/coordinate_chain.h"

namespace tact::host::tracking {

using pose::Pose;

/// The part that carries the marker body.
enum class BodyRole : std::uint8_t {
  kHead,
  kShoulder,
  kWaist,
  kWrist,
  kHand,
  kLeftLeg,
  kRightLeg,
  kLeftAnkle,
  kRightAnkle,
  kTool,
  kLeftHand,
  kElbow,  // of the right arm, which holds the tool
};
inline constexpr std::size_t kBodyRoles = 12;

enum class BodyState : std::uint8_t { kAbsent, kTracked, kHeld, kLost };

/// Why the newest observation of a body gave no pose.
enum class TrackingTrouble : std::uint8_t {
  kNone,
  kSilent,        // no observation
  kTooFewPoints,  // PoseStatus, see epnp.h
  kDegenerate,
  kInvalid,
  kNoPose,
  kJump,        // farther than a body moves in that time
  kFrozen,      // bit-identical numbers: the tracker has stopped
  kOutOfOrder,  // older than the previous observation
};

inline constexpr double kHold_s = 0.1;
inline constexpr double kLose_s = 0.5;

struct TrackedBody {
  BodyState state = BodyState::kAbsent;
  TrackingTrouble trouble = TrackingTrouble::kNone;
  Pose pose{};          // filtered for display
  Pose raw{};           // as solved
  double rms_px = 0.0;  // of the raw pose
  double age_s = 0.0;   // since the last good pose
};

struct TrackedOperator {
  double time_s = 0.0;                           // of the viewer's clock
  std::array<TrackedBody, kBodyRoles> bodies{};  // by BodyRole

  const TrackedBody& operator[](BodyRole role) const {
    return bodies[static_cast<std::size_t>(role)];
  }
  TrackedBody& operator[](BodyRole role) { return bodies[static_cast<std::size_t>(role)]; }
};

}  // namespace tact::host::tracking
