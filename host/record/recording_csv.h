// SPDX-License-Identifier: Apache-2.0
// recording_csv.h - frames as a table: one row per frame, with the values of the newest tick; each
// column's name has the unit.
//
// Numbers are the shortest decimals that read back to the same float. Every probe sphere has its
// columns, in contact or not; site1_u0_m .. are the profile, into the tissue positive. Each tracked
// body has the columns of its raw pose, in W.
#pragma once

#include <string>
#include <vector>

#include "host/record/recording.h"

namespace tact::host::record {

/// Facts of the run and the meaning of a row, in lines that begin with '#', before the header; the
/// table of every tick (firmware/telemetry/tick_csv.h) has the same.
std::string csv_facts(const Hello& hello);

/// Both end with a line break and have the same number of columns.
std::string csv_header(const Hello& hello, const std::vector<tracking::BodyRole>& bodies = {});
void append_csv_row(std::string& out, const Frame& frame, const Hello& hello,
                    const tracking::TrackedOperator* tracked = nullptr,
                    const std::vector<tracking::BodyRole>& bodies = {});

/// The bodies that appear in the recording.
std::vector<tracking::BodyRole> bodies_in(const Recording& recording);
std::vector<tracking::BodyRole> bodies_in(const Snapshot& snapshot);

}  // namespace tact::host::record
