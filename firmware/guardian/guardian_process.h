// SPDX-License-Identifier: Apache-2.0
// guardian_process.h - the guardian process: waits for the end of its tactd, and zeroes the device.
//
//     tactd releases the lock    the guardian ends and sends nothing
//     tactd died, or is held     it sends the shutdown frames (hal/shutdown_frames.h), prints a
//                                message and ends
//
// It can do nothing else: its memory is locked, its system calls are restricted to those above, on
// the device's descriptor only, and it blocks every signal that can be blocked.
#pragma once

namespace tact::firmware::guardian {

/// Takes its orders from `socket` and answers with one byte when it is ready. Exit status: 0 tactd
/// ended regularly, 1 tactd died or was held and the frames were sent, 2 no orders.
int stand_guard(int socket);

}  // namespace tact::firmware::guardian
