// SPDX-License-Identifier: Apache-2.0
// tick_budget.h - is the law fast enough for this rate? Checked once, before the loop: a law that
// exceeds its share of the tick makes the loop late. It is refused, with a remedy. Set-up code.
#pragma once

#include <optional>

#include "firmware/pc/rt_setup.h"
#include "model/contact/contact_law.h"
#include "model/result.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"

namespace tact::firmware::admission {

/// Measured time of the law's part of a tick on this machine.
struct LawTime {
  double median_us = 0.0;
  double p999_us = 0.0;  // 99.9 % of the ticks take at most this long
};

/// All spheres press, each moving on a small circle, so that a patch is gathered repeatedly; a
/// blade, if any, is evaluated at rest. The presses change the state of a law with memory, so
/// measure a twin, not the law that will be rendered. Takes about 0.2 s at most.
LawTime measure_law(const model::scene::Scene& scene, model::contact::ContactLaw& twin,
                    double deepest_m);

struct TimeMargin {
  LawTime measured;
  bool tail_counts = false;  // p99.9 is checked, else the median
  double checked_us = 0.0;
  double budget_us = 0.0;  // [tolerance] tick_budget_us, or half a period without one
};

/// Measures a twin against the budget. With hard real time it runs like the loop and p99.9 counts.
/// A stock kernel preempts at any time, so there only the median characterizes the law.
model::Result<TimeMargin> check_budget(const model::scene::Scene& scene,
                                       const std::optional<pc::RtSettings>& hard_real_time);

}  // namespace tact::firmware::admission
