// SPDX-License-Identifier: Apache-2.0
// limits_for.h - what holds for this scene on this device: of force, torque and workspace the
// smaller of the two; the rest is the scene's.
#pragma once

#include "hal/device.h"
#include "model/limits.h"

namespace tact::firmware::gate {

/// A limit that is no number is 0: nothing is felt.
model::Limits limits_for(const model::Limits& scene, const hal::DeviceInfo& device);

}  // namespace tact::firmware::gate
