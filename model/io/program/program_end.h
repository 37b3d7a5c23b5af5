// SPDX-License-Identifier: Apache-2.0
// program_end.h - how a program ends when its output goes nowhere.
#pragma once

namespace tact::model::io {

/// First in main(): what standard output did not take (a full disk, /dev/full) is reported when the
/// program ends, and the exit status is 2.
void watch_standard_output(const char* program);

/// For programs that move nothing: an uncaught exception of a library (no memory, no
/// room for the output) is reported in one line, with exit status 2 and no core dump.
void report_uncaught(const char* program);

}  // namespace tact::model::io
