// SPDX-License-Identifier: Apache-2.0
// tick_budget.h - is the scene fast enough for its rate? Checked once, before the loop: a tick that
// exceeds its share of the period makes the loop late. It is refused, with a remedy. Set-up code.
#pragma once

#include <optional>

#include "firmware/pc/rt_setup.h"
#include "model/contact/contact_scene.h"
#include "model/result.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"

namespace tact::firmware::admission {

/// Measured time of a tick on this machine: detect, render and limit, without device and clock.
struct TickTime {
  double median_us = 0.0;
  double p999_us = 0.0;  // 99.9 % of the ticks take at most this long
  double longest_us = 0.0;
};

/// The tool presses at the hand's site, on a small circle, so that a patch is gathered repeatedly;
/// ticks in contact count. They change the state of a law with memory and cut with a blade, so
/// measure what tissue_for_check gives. Takes about 0.2 s at most.
TickTime measure_tick(const model::scene::Scene& scene, const model::contact::ContactScene& contact,
                      double deepest_m);

struct TimeMargin {
  TickTime measured;
  bool tail_counts = false;  // p99.9 is checked, else the median
  double checked_us = 0.0;
  double budget_us = 0.0;  // [tolerance] tick_budget_us, or half a period without one
};

/// Measures the tissue, which the loop does not use yet, against the budget. With hard real time it
/// runs like the loop and p99.9 counts. A stock kernel preempts at any time, so there only the
/// median characterizes it.
model::Result<TimeMargin> check_budget(const model::scene::Scene& scene,
                                       const model::scene::Tissue& tissue,
                                       const std::optional<pc::RtSettings>& hard_real_time);

}  // namespace tact::firmware::admission
