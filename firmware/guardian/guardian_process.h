// SPDX-License-Identifier: Apache-2.0
// guardian_process.h - what the guardian process does: waits for the end of its tactd, and zeroes
// the device.
//
//     tactd lets go   it ends, and has sent nothing
//     tactd died      it sends the device's shutdown frames (hal/shutdown_frames.h), informs a
//                     person, ends
//
// It can do no more: its memory is locked, its system calls are filtered down to those, on the
// device's descriptor alone, and it takes no signal but those that nobody can refuse.
#pragma once

namespace tact::firmware::guardian {

/// Takes its orders from `socket`, answers with one byte when it is ready. The exit status: 0 a
/// good end, 1 it zeroed the device, 2 it has no orders.
int stand_guard(int socket);

}  // namespace tact::firmware::guardian
