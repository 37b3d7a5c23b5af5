// SPDX-License-Identifier: Apache-2.0
// start_text.h - what tactd prints before its loop runs: about scene, device and real time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/console/operator_signals.h"
#include "firmware/pc/rt_setup.h"
#include "firmware/run/loop_parts.h"
#include "model/scene/scene.h"

namespace tact::firmware::run {

/// Notes that do not prevent a run; with --check also those that take long to compute.
std::vector<std::string> start_notes(const model::scene::Scene& scene, const LoopParts& parts,
                                     bool is_check);
/// At boot a service may start before the bus of its device is up. Polls once a second, and reports
/// once what it waits for. False: a signal ended the wait.
bool wait_for_bus(const model::scene::Scene& scene, const console::OperatorSignals& signals);
/// The results of --check, in a few lines.
std::string check_lines(const model::scene::Scene& scene, const LoopParts& parts);

/// Hard real time for one run: requests it from the PC and reports what is missing. Exists during
/// the run.
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
