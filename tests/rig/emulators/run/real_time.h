// SPDX-License-Identifier: Apache-2.0
// real_time.h - clock, priority and end of an emulator process. Linux, CLOCK_MONOTONIC, ns.
//
// The emulator replaces hardware: it runs as FIFO below the controller's loop. It leaves FIFO
// before it exits, because a process that gives back its memory at FIFO priority holds up all below
// it.
#pragma once

#include <cstdint>
#include <string>

namespace tact::rig {

std::int64_t monotonic_ns();

/// Locked memory and SCHED_FIFO of this priority; 0 stays as it is. False: the message with the
/// remedy.
bool enter_real_time(int priority, std::string& error);
void leave_real_time();

/// From here SIGTERM and SIGINT only ask.
void catch_stop_signals();
bool stop_asked();

/// Wait until `fd` can be read or the time has come. True: readable (or hung up).
bool wait_readable(int fd, std::int64_t until_ns);

}  // namespace tact::rig
