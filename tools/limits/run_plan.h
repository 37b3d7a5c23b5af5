// SPDX-License-Identifier: Apache-2.0
// run_plan.h - the cases of a plan on the device of a scene, one after the other.
#pragma once

#include <vector>

#include "hal/lines_settings.h"
#include "model/result.h"
#include "tools/limits/real_device/guarded_play.h"
#include "tools/limits/report/report.h"

namespace tact::tools::limits {

struct PlanOptions {
  std::vector<Case> cases;
  bool wall = false;
  /// See LimitsBench.
  model::Limits (*gate_limits)(const model::Limits&) = nullptr;
  /// Called beside the cases, from the caller's thread.
  PlanProgress progress{};
};

/// Why a real device cannot play this case; null: it can. A line that is not wired cannot open, so
/// a fault set in its place would prove nothing.
const char* why_left_out(const Case& c, const hal::LinesSettings& lines);

/// Opens the device, plays and evaluates. A real device is played in real time, guarded as tactd's
/// is (guarded_play.h); the consent comes before (consent.h). An error: the device did not open, or
/// Ctrl-C.
model::Result<LimitsReport> run_plan(const model::scene::Scene& scene, const PlanOptions& options);

}  // namespace tact::tools::limits
