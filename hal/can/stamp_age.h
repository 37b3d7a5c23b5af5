// SPDX-License-Identifier: Apache-2.0
// stamp_age.h - how old a frame is whose stamp is of a clock that may be set.
//
// The kernel stamps frames by the time of day. When that has stepped since the last look, a stamp
// may be of either side of the step, so it has two ages:
//
//     stamped after the step    now - stamp           before it    now - stamp - step
//
// An age is never negative and, when the last look emptied the queue, never more than the time
// since then by the clock that does not step. Where both ages are possible, or neither, the older
// one counts: what is old is never taken for fresh, and at most the frames of one look are lost.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "model/rt.h"

namespace tact::hal::can {

class StampAge {
 public:
  /// Once per look into the queue, with both clocks right after it. `empties`: nothing stays
  /// behind, so what the next look finds is newer than this one.
  void look(std::int64_t wall_ns, std::int64_t monotonic_ns, bool empties) RT_SAFE {
    if (empties_) {
      offset_ns_ = wall_ns_ - monotonic_ns_;
      emptied_ns_ = monotonic_ns_;
    }
    empties_ = empties;
    wall_ns_ = wall_ns;
    monotonic_ns_ = monotonic_ns;
    step_ns_ = emptied_ns_ == kNever ? 0 : wall_ns - monotonic_ns - offset_ns_;
    if (std::abs(step_ns_) < kSlewed_ns) step_ns_ = 0;
  }

  std::int64_t of(std::int64_t stamp_ns) const RT_SAFE {
    const std::int64_t after_ns = wall_ns_ - stamp_ns;
    if (step_ns_ == 0) return std::max<std::int64_t>(0, after_ns);
    const std::int64_t before_ns = after_ns - step_ns_;
    if (possible(after_ns) && !possible(before_ns)) return after_ns;
    if (possible(before_ns) && !possible(after_ns)) return before_ns;
    return std::max(after_ns, before_ns);  // they differ by the step: one is above 0
  }

 private:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();
  static constexpr std::int64_t kSlewed_ns = 100'000;   // no step: slewing, and two reads of clocks
  static constexpr std::int64_t kBetween_ns = 200'000;  // frames that came between look and clocks

  bool possible(std::int64_t age_ns) const RT_SAFE {
    return age_ns >= 0 && age_ns <= monotonic_ns_ - emptied_ns_ + kBetween_ns;
  }

  std::int64_t wall_ns_ = 0, monotonic_ns_ = 0;
  std::int64_t offset_ns_ =
      0;  // wall clock less the other, at the look that emptied the queue last
  std::int64_t emptied_ns_ = kNever;
  std::int64_t step_ns_ = 0;
  bool empties_ = false;  // the last look
};

}  // namespace tact::hal::can
