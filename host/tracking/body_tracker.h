// SPDX-License-Identifier: Apache-2.0
// body_tracker.h - what one body's observations say together: is it tracked, held or lost, and why.
//
//     out of order  time or sequence of a camera does not go on; a step of more than kRestart_s
//                   then is a new beginning: the recording or its sender started again
//     frozen        a camera gave the same numbers, bit by bit, for kFrozen_s
//     jump          faster than kFastest_mps or kFastest_radps (beyond the noise) since the last
//                   good pose, or farther than these reach in kHold_s; the third pose in a row that
//                   agrees with the one before is believed
//     silent        nothing came for kHold_s
//
// Of two cameras the newest good pose counts. If the other camera saw the body within kTogether_s
// of that time, both observations are solved as one problem, which is more accurate (joint_pose.h).
// The pose for display is filtered (one_euro.h). Time is an argument: `time_s` of the tracker's
// clock, `now_s` of the viewer's.
#pragma once

#include <optional>
#include <vector>

#include "host/pose/epnp.h"
#include "host/pose/one_euro.h"
#include "host/tracking/observation.h"
#include "host/tracking/tracked_operator.h"

namespace tact::host::tracking {

inline constexpr double kTogether_s = 0.020;  // looks of two cameras that count as one moment
inline constexpr double kRestart_s = 1.0;
inline constexpr double kFrozen_s = 0.5;
inline constexpr double kFastest_mps = 5.0;     // a hand
inline constexpr double kFastest_radps = 40.0;  // a wrist; a mirrored pose is faster
inline constexpr int kJumpPoses = 3;

/// What a source told of a body once: a camera its points, a tracker a pose. The numbers only tell
/// whether it repeats itself.
struct Look {
  double time_s = 0.0;
  std::uint64_t sequence = 0;
  std::vector<double> value;
};
Look look_of(const Observation& seen);

class BodyTracker {
 public:
  explicit BodyTracker(std::size_t cameras) : streams_(cameras) {}

  /// True if a pose from this observation is wanted: it goes on in time, is not frozen, and not
  /// more than kTogether_s older than the good one.
  bool admit(std::size_t camera, const Look& seen, double now_s);
  /// The last observation of this camera repeats the one before, bit by bit.
  bool repeats(std::size_t camera) const {
    return streams_[camera].same_since_s < streams_[camera].time_s;
  }
  /// The pose of the admitted observation; true if it is the good one now. One that is not newer
  /// than the good one changes nothing.
  bool take(const pose::PoseEstimate& estimate, double time_s, double now_s);
  /// A better pose of the time of the good one, from more views; of another time: false, nothing.
  bool refine(const pose::PoseEstimate& estimate, double time_s);

  TrackedBody at(double now_s) const;
  /// The last good pose, filtered, however old; none if there never was one.
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
  bool is_frozen(Stream& stream, const Look& seen) const;
  /// False while a jump is not believed yet.
  bool is_believed(const Timed& next);
  void show(const pose::PoseEstimate& estimate);

  std::vector<Stream> streams_;
  TrackedBody body_{.state = BodyState::kLost};
  pose::PoseFilter filter_, before_;  // before the good pose
  Timed good_, jump_;
  bool anchored_ = false;  // good_ is of this beginning
  int jump_poses_ = 0;
  bool has_good_ = false, has_seen_ = false;
  double good_now_s_ = 0.0, seen_now_s_ = 0.0;
};

}  // namespace tact::host::tracking
