// SPDX-License-Identifier: Apache-2.0
// recording_csv.h - frames as a table: one row per frame, which is the newest tick at its time, the
// unit in every column's name.
//
// Numbers are the shortest decimals that read back to the same float. Every probe sphere has its
// columns, in contact or not; site1_u0_m .. are the profile, into the tissue positive. Each tracked
// body has the columns of its raw pose, in W.
#pragma once

#include <string>
#include <vector>

#include "host/record/recording.h"

namespace tact::host::record {

/// Which run it was and what a row is, in lines that begin with '#', as the table of every tick has
/// them (firmware/telemetry/tick_csv.h). They stand before the header.
std::string csv_facts(const Hello& hello);

/// Both end with a line break and have the same number of columns.
std::string csv_header(const Hello& hello, const std::vector<tracking::BodyRole>& bodies = {});
void append_csv_row(std::string& out, const Frame& frame, const Hello& hello,
                    const tracking::TrackedOperator* tracked = nullptr,
                    const std::vector<tracking::BodyRole>& bodies = {});

/// The bodies that a tracker looked for.
std::vector<tracking::BodyRole> bodies_in(const Recording& recording);
std::vector<tracking::BodyRole> bodies_in(const Snapshot& snapshot);

}  // namespace tact::host::record
