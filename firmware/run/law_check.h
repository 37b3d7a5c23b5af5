// SPDX-License-Identifier: Apache-2.0
// law_check.h - may this law be felt here? Asked once, before the loop starts.
//
// A spring that is stiffer than device and rate can render starts to shake the hand, and a law that
// takes longer than its share of the tick makes the loop late: both are refused, with what to
// change. Set-up code.
#pragma once

#include <optional>
#include <string>

#include "firmware/pc/rt_setup.h"
#include "hal/device.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"

namespace tact::firmware::run {

struct StiffnessMargin {
  double needed_N_per_m = 0.0;  // by all spheres together
  double limit_N_per_m = 0.0;   // of device, rate and the law's own damping (haptic_limit.h)
};

/// All spheres on the stiffest place at once, pressed and slid. The error says which key is too
/// stiff, or damps too much, and to what it must fall.
model::Result<StiffnessMargin> check_renderable(const model::scene::Scene& scene,
                                                const model::scene::Tissue& tissue,
                                                const hal::DeviceInfo& device);

/// Time of a law's share of a tick on this machine.
struct LawTime {
  double median_us = 0.0;
  double p999_us = 0.0;  // 99.9 % of the ticks are at most this long
};

/// All spheres pressed, each on its way round a small circle, so that a patch gathers anew; a blade
/// that stands still is asked for too. What it presses is forgotten: a law that remembers must be
/// measured on a twin, not on the one that will be felt. About 0.2 s at most.
LawTime measure_law(const model::scene::Scene& scene, model::contact::SiteLaw& twin,
                    double deepest_m);

struct TimeMargin {
  LawTime measured;
  bool tail_counts = false;  // p99.9 was judged, else the median
  double judged_us = 0.0;
  double budget_us = 0.0;  // [tolerance] tick_budget_us, or half a period without one
};

/// A twin against the budget. With hard real time it runs as the loop will and its p99.9 counts; a
/// stock kernel takes the processor away at will, so there only the median tells about the law.
model::Result<TimeMargin> check_budget(const model::scene::Scene& scene,
                                       const std::optional<pc::RtSettings>& hard_real_time);

/// A sentence for people where the hand's own strokes press so fast that the inertia of tissue,
/// which the law leaves out, would be felt (IN-2); empty where they do not, or the law has masses.
std::string inertia_note(const model::scene::Scene& scene, const model::scene::TissueLaw& law);

}  // namespace tact::firmware::run
