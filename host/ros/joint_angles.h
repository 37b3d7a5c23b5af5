// SPDX-License-Identifier: Apache-2.0
// joint_angles.h - from a logged tick to the angles and rates of the device's driven joints.
//
//     theta = the device's own inverse kinematics of p_D,    thetadot = K v_D
//
// p_D, v_D: handle in the device's frame (model/device_joints.h). The log has the tool, which the
// clutch shifts, and the handle's velocity, as the device's observer has estimated it.
#pragma once

#include <optional>

#include "firmware/protocol/logged_tick.h"
#include "firmware/protocol/run_header.h"
#include "host/ros/ros_topics.h"

namespace tact::host::ros {

/// Nothing where no joints are known, before the first sample, and out of the device's reach.
std::optional<JointState> joints_in(const firmware::protocol::RunHeader& run,
                                    const firmware::protocol::LoggedTick& tick);

}  // namespace tact::host::ros
