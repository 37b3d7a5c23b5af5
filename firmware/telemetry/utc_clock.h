// SPDX-License-Identifier: Apache-2.0
// utc_clock.h - reads CLOCK_MONOTONIC and UTC as a pair. Not for the loop.
#pragma once

#include <string>

#include "firmware/protocol/record_parts.h"

namespace tact::firmware::telemetry {

protocol::UtcOffset read_utc_offset();
/// 2026-01-31T12:00:00.123456789Z
std::string date_of(std::int64_t utc_ns);

}  // namespace tact::firmware::telemetry
