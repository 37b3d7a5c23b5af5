// SPDX-License-Identifier: Apache-2.0
// bound_bone.h - one bone that follows its tracker: bound once, then driven; it holds or fades with
// the tracker's state, and never jumps.
//
//     first good pose    TR-5 against the neutral pose, so the bone stays where it is
//     kTracked           TR-6
//     kHeld              the bone holds
//     kLost, kAbsent     fades to the neutral pose in 1 s
//     tracked again, or a step faster than a body moves: fades in over 0.3 s
//
// A long fade takes more time, so that its mean speed stays below kGlide_mps. A pose that is not
// finite counts as held. Time comes as dt_s, s, >= 0. For display, not for the force loop.
#pragma once

#include <optional>

#include "host/tracking/tracked_operator.h"

namespace tact::host::figure {

using pose::Pose;
using tracking::BodyRole;
using tracking::BodyState;
using tracking::kBodyRoles;
using tracking::TrackedBody;
using tracking::TrackedOperator;
using tracking::TrackingTrouble;

inline constexpr double kFade_s = 1.0, kReturn_s = 0.3;
inline constexpr double kGlide_mps = 1.5;
inline constexpr double kFadeAbove_mps = 5.0, kFadeAbove_radps = 20.0;  // of a part of the body

/// Finite, and its rotation is a unit quaternion.
bool is_good(const Pose& pose);

class BoundBone {
 public:
  /// The bone's pose now. `neutral`: its pose without a tracker, also the binding pose.
  const Pose& follow(const TrackedBody& body, const Pose& neutral, double dt_s);
  /// Influence of the tracker: 0 neutral, 1 follows or holds; intermediate during a fade.
  double share() const { return share_; }
  const Pose& now() const { return shown_; }
  const std::optional<Pose>& offset() const { return offset_; }

 private:
  enum class Mode : std::uint8_t { kNeutral, kFollows, kHolds, kFades };

  void begin_fade(const Pose& to, double least_s);
  /// Interpolates pose and share between the start of the fade and `to`.
  Pose faded(const Pose& to, double to_share, double dt_s);

  std::optional<Pose> offset_;  // TR-5
  Mode mode_ = Mode::kNeutral;
  Pose shown_{}, target_{}, from_{};
  double faded_s_ = 0.0, fade_s_ = kReturn_s;
  double share_ = 0.0, faded_from_ = 0.0;  // faded_from_: the share where the fade began
};

}  // namespace tact::host::figure
