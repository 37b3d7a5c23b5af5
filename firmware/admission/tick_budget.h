// SPDX-License-Identifier: Apache-2.0
// tick_budget.h - is the law fast enough for this rate? Asked once, before the loop starts: one
// that takes longer than its share of the tick makes the loop late. It is refused, with what to
// change. Set-up code.
#pragma once

#include <optional>

#include "firmware/pc/rt_setup.h"
#include "model/contact/contact_law.h"
#include "model/result.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"

namespace tact::firmware::admission {

/// Time of a law's share of a tick on this machine.
struct LawTime {
  double median_us = 0.0;
  double p999_us = 0.0;  // 99.9 % of the ticks are at most this long
};

/// All spheres pressed, each on its way round a small circle, so that a patch gathers again; a
/// blade that stands still is asked for too. What it presses is forgotten: a law that remembers
/// must be measured on a twin, not on the one that will be felt. About 0.2 s at most.
LawTime measure_law(const model::scene::Scene& scene, model::contact::ContactLaw& twin,
                    double deepest_m);

struct TimeMargin {
  LawTime measured;
  bool tail_counts = false;  // p99.9 was judged, else the median
  double checked_us = 0.0;
  double budget_us = 0.0;  // [tolerance] tick_budget_us, or half a period without one
};

/// A twin against the budget. With hard real time it runs as the loop will and its p99.9 counts; a
/// stock kernel takes the processor away at will, so there only the median tells about the law.
model::Result<TimeMargin> check_budget(const model::scene::Scene& scene,
                                       const std::optional<pc::RtSettings>& hard_real_time);

}  // namespace tact::firmware::admission
