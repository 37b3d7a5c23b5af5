// SPDX-License-Identifier: Apache-2.0
// igtl_frame.h - a frame of tactd as OpenIGTLink messages.
//
//     TRANSFORM ToolToDevice    the tool in frame W
//     TRANSFORM ForceToDevice   at the tool's point, +z along the force, scaled by its newtons (at
//                               least kMinForce_N): an arrow along +z becomes the force
//     SENSOR    Force           the force on the hand along W's axes, N
#pragma once

#include <string>

#include "host/igtl/igtl_wire.h"
#include "host/record/telemetry_check.h"

namespace tact::host::igtl {

inline constexpr double kMinForce_N = 1e-3;  // keeps the transform invertible

/// The three messages in sequence. Empty if a number of the frame is not finite.
std::string frame_messages(const record::Frame& frame, double time_s);

/// Code by the device's state: off is not ready (13), stopped is disabled (15), ready and armed are
/// good (1). The subcode is the fault's number.
Status status_of(const record::Frame& frame);
/// Without a tactd: time out (7).
Status lost_status();

}  // namespace tact::host::igtl
