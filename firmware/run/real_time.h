// SPDX-License-Identifier: Apache-2.0
// real_time.h - hard real time for one run: what the PC gives, and what it lacks.
#pragma once

#include <optional>
#include <vector>

#include "firmware/pc/rt_setup.h"

namespace tact::firmware::run {

/// Lasts as long as the run.
class RealTime {
 public:
  /// Locks memory and the like, and tries what the loop's threads need.
  void enter(const pc::RtSettings& settings);
  /// What is missing, and what of this PC will make the loop late, to standard error.
  void report(const pc::RtSettings& settings) const;
  /// Empty: hard real time, or nobody asked for it.
  const std::vector<pc::Shortfall>& shortfalls() const { return shortfalls_; }

 private:
  std::vector<pc::Shortfall> shortfalls_;
  std::optional<pc::ProcessSetup> process_;
};

}  // namespace tact::firmware::run
