// SPDX-License-Identifier: Apache-2.0
// tick_csv.h - the ticks of a log or of a black box as a table, one row a tick at the loop's rate.
//
// Columns have the names of the viewer's CSV where they are the same thing (recording_csv.h), with
// every digit: force_* is what was written to the device after the gate, wanted_* what the law
// asked for, limit and acted the number and name of what last limited it: a stage of the gate, the
// end of the law, a tool inside the organ, or lost contact. Phases are us; publish and total are
// those of the tick before. Lines that begin with # say which run it was.
#pragma once

#include <string>

#include "firmware/telemetry/tick_log.h"

namespace tact::firmware::telemetry {

/// Both end with a line break; the columns of the second are named in the last line of the first.
std::string tick_csv_head(const LogHeader& header);
std::string tick_csv_row(const LoggedTick& tick);

/// Writes all good ticks of a log. Empty, or what is damaged; an error if nothing could be read or
/// written.
model::Result<std::string> write_tick_csv(const std::string& log_path, const std::string& csv_path);

}  // namespace tact::firmware::telemetry
