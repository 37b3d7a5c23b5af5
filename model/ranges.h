// SPDX-License-Identifier: Apache-2.0
// ranges.h - what a parameter must be, asked before anything is built from it.
#pragma once

#include <cmath>

#include "model/rt.h"

namespace tact::model {

inline bool is_positive(double v) RT_SAFE { return std::isfinite(v) && v > 0.0; }
inline bool is_not_negative(double v) RT_SAFE { return std::isfinite(v) && v >= 0.0; }

}  // namespace tact::model
