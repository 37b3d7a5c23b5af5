// status_line.h - one run in one line, for a terminal.
#pragma once

#include <string>

#include "firmware/telemetry_record.h"

namespace tact::firmware {

/// Time, rate, late ticks, force, state, and the fault or limit that acts.
std::string status_line(const Frame& frame, double rate_Hz);

}  // namespace tact::firmware
