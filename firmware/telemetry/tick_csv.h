// SPDX-License-Identifier: Apache-2.0
// tick_csv.h - the ticks of a log or a black box as a table, one row per tick.
//
// Columns that the viewer's CSV also has carry the same names (recording_csv.h). Values have all
// digits. force_* is what was written to the device after the gate, wanted_* the law's force.
// limit and acted are number and name of the last limitation: a stage of the gate, the end of the
// law's range, a tool inside the organ, or lost contact. Phases are us; publish and total belong to
// the tick before. Lines that begin with # identify the run.
#pragma once

#include <string>

#include "firmware/telemetry/tick_log.h"

namespace tact::firmware::telemetry {

/// Both end with a line break; the last line of the head names the columns.
std::string tick_csv_head(const LogHeader& header);
std::string tick_csv_row(const LoggedTick& tick);

/// Writes all good ticks of a log. Returns a description of the damage, or an empty string. An
/// error if the log cannot be read or the table cannot be written.
model::Result<std::string> write_tick_csv(const std::string& log_path, const std::string& csv_path);

}  // namespace tact::firmware::telemetry
