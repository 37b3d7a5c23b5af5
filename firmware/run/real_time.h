// SPDX-License-Identifier: Apache-2.0
// real_time.h - hard real time for one run: requests it from the PC and reports what is missing.
#pragma once

#include <optional>
#include <vector>

#include "firmware/pc/rt_setup.h"

namespace tact::firmware::run {

/// Exists during the run.
class RealTime {
 public:
  /// Locks memory, holds the power latency, and tries what the loop's threads need.
  void enter(const pc::RtSettings& settings);
  /// Prints what is missing, and what else on this PC delays the loop, to standard error.
  void report(const pc::RtSettings& settings) const;
  /// Empty: hard real time, or it was not requested.
  const std::vector<pc::Shortfall>& shortfalls() const { return shortfalls_; }

 private:
  std::vector<pc::Shortfall> shortfalls_;
  std::optional<pc::ProcessSetup> process_;
};

}  // namespace tact::firmware::run
