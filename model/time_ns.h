// SPDX-License-Identifier: Apache-2.0
// time_ns.h - integer nanoseconds, as clocks and stamps count them.
#pragma once

#include <cmath>
#include <cstdint>

namespace tact::model {

inline constexpr std::int64_t kMillisecond_ns = 1'000'000, kSecond_ns = 1'000'000'000;

/// The period of a loop or a bus, to the nearest nanosecond.
inline std::int64_t period_ns(double rate_Hz) { return std::llround(1e9 / rate_Hz); }

}  // namespace tact::model
