// SPDX-License-Identifier: Apache-2.0
#include "host/figure/bound_bone.h"

#include <algorithm>
#include <cmath>

namespace tact::host::figure {
namespace {

constexpr double kTolerance_m = 0.02, kTolerance_rad = 0.1;  // of one step, for noise

bool is_step_too_fast(const Pose& from, const Pose& to, double dt_s) {
  return (to.position_m - from.position_m).norm() > kFadeAbove_mps * dt_s + kTolerance_m ||
         from.rotation.angularDistance(to.rotation) > kFadeAbove_radps * dt_s + kTolerance_rad;
}

}  // namespace

bool is_good(const Pose& pose) {
  return pose.position_m.allFinite() && std::abs(pose.rotation.norm() - 1.0) < 1e-6;
}

const Pose& BoundBone::follow(const TrackedBody& body, const Pose& neutral, double dt_s) {
  const bool good = is_good(body.pose);
  if (body.state == BodyState::kTracked && good) {
    if (!offset_) {
      // TR-5, once: later poses of the tracker move the bone relative to this one.
      offset_ = pose::bind(body.pose, neutral);
      shown_ = target_ = neutral;
    }
    const Pose next = pose::drive(body.pose, *offset_);
    if (mode_ == Mode::kNeutral) shown_ = neutral;
    // After a gap or a jump of the tracker the bone fades, so that the limb does not jump.
    if (mode_ != Mode::kFollows || is_step_too_fast(target_, next, dt_s))
      begin_fade(next, kReturn_s);
    mode_ = Mode::kFollows;
    target_ = next;
    shown_ = faded(next, 1.0, dt_s);
  } else if (body.state == BodyState::kTracked || body.state == BodyState::kHeld) {
    if (mode_ == Mode::kNeutral) shown_ = neutral;
    if (mode_ == Mode::kFollows) mode_ = Mode::kHolds;
  } else if (mode_ == Mode::kFollows || mode_ == Mode::kHolds) {
    begin_fade(neutral, kFade_s);
    mode_ = Mode::kFades;
  }
  if (mode_ == Mode::kFades) {
    shown_ = faded(neutral, 0.0, dt_s);
    if (faded_s_ >= fade_s_) mode_ = Mode::kNeutral;
  }
  if (mode_ == Mode::kNeutral) shown_ = neutral;
  return shown_;
}

void BoundBone::begin_fade(const Pose& to, double least_s) {
  // Starts from the pose shown now, even in the middle of an earlier fade.
  from_ = shown_;
  faded_from_ = share_;
  faded_s_ = 0.0;
  fade_s_ = std::max(least_s, (to.position_m - from_.position_m).norm() / kGlide_mps);
}

Pose BoundBone::faded(const Pose& to, double to_share, double dt_s) {
  faded_s_ = std::min(faded_s_ + dt_s, fade_s_);
  const double t = faded_s_ / fade_s_;
  const double part = t * t * (3.0 - 2.0 * t);  // zero speed at both ends
  share_ = faded_from_ + part * (to_share - faded_from_);
  return t < 1.0 ? pose::between(from_, to, part) : to;
}

}  // namespace tact::host::figure
