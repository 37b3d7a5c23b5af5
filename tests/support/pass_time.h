// SPDX-License-Identifier: Apache-2.0
// pass_time.h - a tick that takes long, in simulated time.
#pragma once

#include <cstdint>

#include "firmware/loop/clock.h"

namespace tact::tests {

inline void pass_ns(firmware::loop::SimulatedClock& clock, std::int64_t duration_ns) RT_SAFE {
  clock.sleep_until_ns(clock.now_ns() + duration_ns);
}

}  // namespace tact::tests
