// SPDX-License-Identifier: Apache-2.0
// status_line.h - one run in one line, for a terminal.
#pragma once

#include <string>

#include "firmware/telemetry/telemetry_record.h"

namespace tact::firmware::console {

/// Time, rate, late ticks, force, state, the fault or limit that acts, and how often contact was
/// lost. The rate is ticks over time since `before`; 0 when no time has passed.
std::string status_line(const telemetry::Frame& frame, const telemetry::Frame& before);

}  // namespace tact::firmware::console
