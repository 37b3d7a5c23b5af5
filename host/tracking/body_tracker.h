// SPDX-License-Identifier: Apache-2.0
// body_tracker.h - the state of one body from its observations: tracked, held or lost, and why.
//
//     out of order  time or sequence of a camera does not increase; a step of more than kRestart_s
//                   is a restart of the recording or of its sender
//     frozen        a camera gave bit-identical numbers for kFrozen_s
//     jump          faster than kFastest_mps or kFastest_radps (beyond the noise) since the last
//                   good pose, or farther than these speeds reach in kHold_s; accepted when three
//                   poses in a row each agree with the previous one
//     silent        no observation for kHold_s
//
// With several cameras the newest good pose counts. If the other camera saw the body within
// kTogether_s of it, both observations are solved as one problem, which is more accurate
// (joint_pose.h). The displayed pose is filtered (one_euro.h). Time is an argument: `time_s` of the
// tracker's clock, `now_s` of the viewer's.
#pragma once

#include <optional>
#include <vector>

#include "host/pose/epnp.h"
#include "host/pose/one_euro.h"
#include "host/tracking/observation.h"
#include "host/tracking/tracked_operator.h"

namespace tact::host::tracking {

inline constexpr double kTogether_s = 0.020;  // observations of two cameras treated as simultaneous
inline constexpr double kRestart_s = 1.0;
inline constexpr double kFrozen_s = 0.5;
inline constexpr double kFastest_mps = 5.0;     // a hand
inline constexpr double kFastest_radps = 40.0;  // a wrist; a mirrored pose is faster
inline constexpr int kJumpPoses = 3;

/// One observation of a body: points from a camera, or a pose from a tracker. The numbers only
/// serve to detect repetition.
struct TrackedSample {
  double time_s = 0.0;
  std::uint64_t sequence = 0;
  std::vector<double> value;
};
TrackedSample sample_of(const Observation& seen);

class BodyTracker {
 public:
  explicit BodyTracker(std::size_t cameras) : streams_(cameras) {}

  /// True if a pose from this observation is needed: its time increases, it is not frozen, and not
  /// more than kTogether_s older than the good one.
  bool admit(std::size_t camera, const TrackedSample& seen, double now_s);
  /// True if the last observation of this camera is bit-identical to the one before.
  bool repeats(std::size_t camera) const {
    return streams_[camera].same_since_s < streams_[camera].time_s;
  }
  /// Takes the pose of the admitted observation; true if it is now the good one. A pose that is not
  /// newer than the good one changes nothing.
  bool take(const pose::PoseEstimate& estimate, double time_s, double now_s);
  /// Replaces the good pose by a better one of the same time, from more views; false otherwise.
  bool refine(const pose::PoseEstimate& estimate, double time_s);

  TrackedBody at(double now_s) const;
  /// The last good pose, filtered, of any age; none if there was none.
  std::optional<Pose> last_pose() const {
    return has_good_ ? std::optional(body_.pose) : std::nullopt;
  }

 private:
  struct Stream {  // of one camera
    bool started = false;
    double time_s = 0.0, same_since_s = 0.0;
    std::uint64_t sequence = 0;
    std::vector<double> value;
  };
  struct Timed {
    Pose pose{};
    double time_s = 0.0;
  };
  void begin_again();
  bool is_frozen(Stream& stream, const TrackedSample& seen) const;
  /// False until a jump is accepted.
  bool is_believed(const Timed& next);
  void show(const pose::PoseEstimate& estimate);

  std::vector<Stream> streams_;
  TrackedBody body_{.state = BodyState::kLost};
  pose::PoseFilter filter_, before_;  // before_: its state before the good pose
  Timed good_, jump_;
  bool anchored_ = false;  // good_ belongs to the present run of the sender
  int jump_poses_ = 0;
  bool has_good_ = false, has_seen_ = false;
  double good_now_s_ = 0.0, seen_now_s_ = 0.0;
};

}  // namespace tact::host::tracking
