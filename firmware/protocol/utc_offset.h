// SPDX-License-Identifier: Apache-2.0
// utc_offset.h - UTC by CLOCK_MONOTONIC, in each head and each record, so that runs of two computers
// can be laid over each other (telemetry/utc_clock.h reads it).
#pragma once

#include <cstdint>

namespace tact::firmware::protocol {

/// As the kernel has it: no time service keeps the clock.
inline constexpr std::uint32_t kMaxUtcError_us = 16'000'000;

struct UtcOffset {
  std::int64_t offset_ns = 0;  // since 1970; UTC is CLOCK_MONOTONIC plus this
  // As chrony, ntpd or phc2sys tell the kernel (adjtimex), with the time that the reading took
  std::uint32_t max_error_us = kMaxUtcError_us;
  std::uint32_t error_us = kMaxUtcError_us;
};

}  // namespace tact::firmware::protocol
