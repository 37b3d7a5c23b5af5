// SPDX-License-Identifier: Apache-2.0
// rt_needs.h - the requirements of hard real time, each with its reason, for the doctor's rows
// (pc_check.h) and for a start that lacks them (rt_setup.h). Remedies: hal/rights_remedy.h.
#pragma once

namespace tact::firmware::pc {

inline constexpr int kLoopPriority = 80;   // SCHED_FIFO
inline constexpr int kWatchAboveLoop = 5;  // the watch's priority over the loop's

// Why each matters.
inline constexpr const char* kKernelReason = "any driver can delay a tick by milliseconds";
inline constexpr const char* kMemoryReason = "a page fault can stop the loop for milliseconds";
inline constexpr const char* kPriorityReason = "other programs can hold up the loop";
inline constexpr const char* kPowerReason = "the CPU may sleep deeply between ticks and wake late";
inline constexpr const char* kKernelRemedy = "sudo apt install linux-image-rt-amd64, then boot it";

}  // namespace tact::firmware::pc
