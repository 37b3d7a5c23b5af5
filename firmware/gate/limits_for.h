// SPDX-License-Identifier: Apache-2.0
// limits_for.h - limits of a scene on a device: for force, torque and workspace the smaller of the
// two, the others from the scene.
#pragma once

#include "hal/device.h"
#include "model/limits.h"

namespace tact::firmware::gate {

/// A limit that is NaN becomes 0: no force.
model::Limits limits_for(const model::Limits& scene, const hal::DeviceInfo& device);

}  // namespace tact::firmware::gate
