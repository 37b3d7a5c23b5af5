// SPDX-License-Identifier: Apache-2.0
// recording_csv.h - frames as a table: one row per frame, with the values of the newest tick.
//
// The columns are the fields of firmware/protocol/frame.cc (record_text.h says how they are named),
// then the patch's sums, then the raw pose of each tracked body in W. Every probe sphere has its
// columns, in contact or not; contact1_profile_0_m .. are the profile, into the tissue positive.
#pragma once

#include <string>
#include <vector>

#include "host/record/recording.h"

namespace tact::host::record {

/// Facts of the run and the meaning of a row, in lines that begin with '#', before the header; the
/// table of every tick (firmware/telemetry/tick_csv.h) has the same.
std::string csv_facts(const RunHeader& header);

/// Both end with a line break and have the same number of columns.
std::string csv_header(const RunHeader& header, const std::vector<tracking::BodyRole>& bodies = {});
void append_csv_row(std::string& out, const Frame& frame, const RunHeader& header,
                    const tracking::TrackedOperator* tracked = nullptr,
                    const std::vector<tracking::BodyRole>& bodies = {});

/// The bodies that appear in the recording.
std::vector<tracking::BodyRole> bodies_in(const Recording& recording);
std::vector<tracking::BodyRole> bodies_in(const Snapshot& snapshot);

}  // namespace tact::host::record
