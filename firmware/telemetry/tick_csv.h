// SPDX-License-Identifier: Apache-2.0
// tick_csv.h - the ticks of a log or a black box as a table, one row per tick.
//
// A column is a field of firmware/protocol/logged_tick.cc (record_text.h says how it is named).
// limit is the last limitation: a stage of the gate, the end of the law's range, a tool inside the
// organ, or lost contact. Lines that begin with # identify the run.
#pragma once

#include <string>

#include "firmware/protocol/tick_log.h"

namespace tact::firmware::telemetry {

/// Writes all good ticks of a log. Returns a description of the damage, or an empty string. An
/// error if the log cannot be read or the table cannot be written.
model::Result<std::string> write_tick_csv(const std::string& log_path, const std::string& csv_path);

}  // namespace tact::firmware::telemetry
