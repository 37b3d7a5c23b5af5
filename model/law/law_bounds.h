// SPDX-License-Identifier: Apache-2.0
// law_bounds.h - the extremes of a law, which a device must be able to show. Set-up code only.
#pragma once

#include "model/law/law.h"

namespace tact::model::law {

/// Largest dF/dd between two depths, seen from inside; NaN if one of them is.
double stiffest_N_per_m(const Law& law, double from_m, double to_m);

/// Largest b inside the range.
double most_damping_Ns_per_m(const Law& law);

/// How far out a held contact point comes before it tears, or the end of the law's range, m, <= 0.
double tear_depth_m(const Law& law, double tear_force_N);

}  // namespace tact::model::law
