// SPDX-License-Identifier: Apache-2.0
// submission.h - a measurement as one row of the table of PCs, tools/deploy/PCS.md.
#pragma once

#include <string>

#include "tools/jitter/run/jitter_run.h"

namespace tact::tools::jitter {

inline constexpr const char* kSubmissionHead =
    "| CPU, cores | kernel | settings | wake-up p99.9, us | deadline to force p99.9, us | largest, "
    "us | duration, s |\n|---|---|---|---|---|---|---|\n";

/// How a row of this PC begins: a file that begins otherwise is none, or another PC's.
std::string submission_beginning();

/// A row of that table with its line end. Neither the PC's name nor its user's stands in it.
std::string make_submission(const JitterResult& result);

}  // namespace tact::tools::jitter
