// SPDX-License-Identifier: Apache-2.0
// limits_for.h - what holds for this scene on this device: the smaller of the two, everywhere.
#pragma once

#include "hal/device.h"
#include "model/limits.h"

namespace tact::firmware::gate {

model::Limits limits_for(const model::Limits& scene, const hal::DeviceInfo& device);

}  // namespace tact::firmware::gate
