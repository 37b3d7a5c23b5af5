// recording_csv.h - frames as a table: one row per frame, the unit in every column's name.
//
// Numbers are the shortest decimals that read back to the same float. Every probe sphere has its
// columns, in contact or not; site1_u0_m .. are the profile, into the tissue positive.
#pragma once

#include <string>

#include "host/telemetry_check.h"

namespace tact::host {

/// Both end with a line break and have the same number of columns.
std::string csv_header(const Hello& hello);
void append_csv_row(std::string& out, const Frame& frame, const Hello& hello);

}  // namespace tact::host
