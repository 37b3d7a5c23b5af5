// SPDX-License-Identifier: Apache-2.0
#include "host/tracking/body_tracker.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tact::host::tracking {
namespace {

// Noise and camera calibration may add this to a motion.
constexpr double kNoise_m = 0.02, kNoise_rad = 0.1;

constexpr std::array kTroubleOf{TrackingTrouble::kNone, TrackingTrouble::kTooFewPoints,
                                TrackingTrouble::kDegenerate, TrackingTrouble::kInvalid,
                                TrackingTrouble::kNoPose};  // by pose::PoseStatus
static_assert(kTroubleOf.size() == static_cast<std::size_t>(pose::PoseStatus::kNoPose) + 1);

bool is_reachable(const Pose& from, const Pose& to, double since_s) {
  const double period_s = std::min(since_s, kHold_s);  // limits the reach after a long gap
  return (to.position_m - from.position_m).norm() <= kFastest_mps * period_s + kNoise_m &&
         to.rotation.angularDistance(from.rotation) <= kFastest_radps * period_s + kNoise_rad;
}

}  // namespace

TrackedSample sample_of(const Observation& seen) {
  TrackedSample out{.time_s = seen.time_s, .sequence = seen.sequence, .value = {}};
  for (const SeenMarker& point : seen.points)
    out.value.insert(out.value.end(),
                     {static_cast<double>(point.id), point.pixel_px.x(), point.pixel_px.y()});
  return out;
}

void BodyTracker::begin_again() {
  for (Stream& stream : streams_) stream = {};
  anchored_ = false;
  jump_poses_ = 0;
}

bool BodyTracker::is_frozen(Stream& stream, const TrackedSample& seen) const {
  // A working camera has noise, so bit-identical points for this long mean a frozen image. Empty
  // observations prove nothing.
  if (seen.value.empty() || seen.value != stream.value) {
    stream.value = seen.value;
    stream.same_since_s = seen.time_s;
  }
  return seen.time_s - stream.same_since_s >= kFrozen_s;
}

bool BodyTracker::admit(std::size_t camera, const TrackedSample& seen, double now_s) {
  Stream& stream = streams_[camera];
  // The sender is alive, even if this observation is rejected: the body is not "silent".
  seen_now_s_ = now_s;
  has_seen_ = true;
  const bool goes_on = seen.time_s > stream.time_s && seen.sequence > stream.sequence;
  if (stream.started && !goes_on) {
    // UDP may reorder; a step of more than a second is a restart of the sender.
    if (std::abs(seen.time_s - stream.time_s) <= kRestart_s) {
      body_.trouble = TrackingTrouble::kOutOfOrder;
      return false;
    }
    begin_again();
  }
  stream.started = true;
  stream.time_s = seen.time_s;
  stream.sequence = seen.sequence;
  if (is_frozen(stream, seen)) {
    body_.trouble = TrackingTrouble::kFrozen;
    return false;
  }
  return !(anchored_ && seen.time_s < good_.time_s - kTogether_s);  // another camera is ahead
}

bool BodyTracker::is_believed(const Timed& next) {
  if (!anchored_ || is_reachable(good_.pose, next.pose, next.time_s - good_.time_s)) return true;
  const bool agrees =
      jump_poses_ > 0 && is_reachable(jump_.pose, next.pose, std::abs(next.time_s - jump_.time_s));
  // Three poses that agree: the body was moved while hidden. A mirrored pose occurs singly.
  jump_poses_ = agrees ? jump_poses_ + 1 : 1;
  jump_ = next;
  return jump_poses_ >= kJumpPoses;
}

bool BodyTracker::take(const pose::PoseEstimate& estimate, double time_s, double now_s) {
  if (anchored_ && time_s <= good_.time_s) return false;
  body_.trouble = kTroubleOf[static_cast<std::size_t>(estimate.status)];
  if (estimate.status != pose::PoseStatus::kOk) return false;
  const Timed next{.pose = estimate.pose, .time_s = time_s};
  if (!is_believed(next)) {
    body_.trouble = TrackingTrouble::kJump;
    return false;
  }
  const bool breaks = !anchored_ || jump_poses_ >= kJumpPoses || time_s - good_.time_s > kLose_s;
  // Without a reset the filter would move the body across the gap.
  if (breaks) filter_.reset();
  jump_poses_ = 0;
  anchored_ = has_good_ = true;
  good_ = next;
  good_now_s_ = now_s;
  // Saved for refine(), so that one moment does not advance the filter twice.
  before_ = filter_;
  show(estimate);
  return true;
}

bool BodyTracker::refine(const pose::PoseEstimate& estimate, double time_s) {
  if (!anchored_ || time_s != good_.time_s || estimate.status != pose::PoseStatus::kOk)
    return false;
  body_.trouble = TrackingTrouble::kNone;
  good_.pose = estimate.pose;
  filter_ = before_;
  show(estimate);
  return true;
}

void BodyTracker::show(const pose::PoseEstimate& estimate) {
  body_.raw = estimate.pose;
  body_.rms_px = estimate.rms_px;
  body_.pose = filter_.next(estimate.pose, good_.time_s);
}

TrackedBody BodyTracker::at(double now_s) const {
  TrackedBody out = body_;
  if (!has_seen_ || now_s - seen_now_s_ > kHold_s) out.trouble = TrackingTrouble::kSilent;
  // Without any good pose the age is the time of the viewer's clock.
  out.age_s = has_good_ ? now_s - good_now_s_ : now_s;
  out.state = !has_good_ || out.age_s > kLose_s ? BodyState::kLost
              : out.age_s > kHold_s             ? BodyState::kHeld
                                                : BodyState::kTracked;
  return out;
}

}  // namespace tact::host::tracking
