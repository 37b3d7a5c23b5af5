// SPDX-License-Identifier: Apache-2.0
// rt_needs.h - the requirements of hard real time, each with reason and remedy, for the doctor's
// rows (pc_check.h) and for a start that lacks them (rt_setup.h).
#pragma once

namespace tact::firmware::pc {

inline constexpr int kLoopPriority = 80;   // SCHED_FIFO
inline constexpr int kWatchAboveLoop = 5;  // the watch's priority over the loop's

/// Why a requirement matters, and the remedy.
struct Reason {
  const char* why;
  const char* remedy;
};
/// Sets kernel parameters, CPU speed and interrupts.
inline constexpr const char* kRtPackageRemedy = "sudo apt install ./tact_*.deb ./tact-rt_*.deb";
/// Grants the group's rights.
inline constexpr const char* kGroupRemedy =
    "sudo apt install ./tact_*.deb, sudo adduser $USER haptics, then log in again";

inline constexpr Reason kKernelReason{"any driver can delay a tick by milliseconds",
                                      "sudo apt install linux-image-rt-amd64, then boot it"};
inline constexpr Reason kMemoryReason{"a page fault can stop the loop for milliseconds",
                                      kGroupRemedy};
inline constexpr Reason kPriorityReason{"other programs can hold up the loop", kGroupRemedy};
inline constexpr Reason kPowerReason{"the CPU may sleep deeply between ticks and wake late",
                                     kGroupRemedy};

}  // namespace tact::firmware::pc
