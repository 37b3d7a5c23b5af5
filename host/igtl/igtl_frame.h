// SPDX-License-Identifier: Apache-2.0
// igtl_frame.h - what a frame of tactd says, as OpenIGTLink messages.
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

inline constexpr double kMinForce_N = 1e-3;  // of a transform that has an inverse

/// The three messages, one behind the other. Empty: the frame has a number that is not finite.
std::string frame_messages(const record::Frame& frame, double time_s);

/// Of the device: off is not ready (13), stopped is disabled (15), ready and armed are good (1).
/// Its subcode is the fault's number.
Status status_of(const record::Frame& frame);
/// There is no tactd (7, time out).
Status lost_status();

}  // namespace tact::host::igtl
