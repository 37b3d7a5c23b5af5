// SPDX-License-Identifier: Apache-2.0
// law_bounds.h - extremes of a law that a device must be able to render. Set-up code only.
#pragma once

#include "model/law/law.h"

namespace tact::model::law {

/// Largest dF/dd between two depths, one-sided at both ends; NaN if a depth is NaN.
double stiffest_N_per_m(const Law& law, double from_m, double to_m);

/// Largest b inside the range.
double most_damping_Ns_per_m(const Law& law);

/// Depth at which a held contact point tears, or the pull limit of the law, m, <= 0.
double tear_depth_m(const Law& law, double tear_force_N);

}  // namespace tact::model::law
