// SPDX-License-Identifier: Apache-2.0
// torque_note.h - which part of the tool's wrench does this device not show?
#pragma once

#include <string>

#include "hal/device.h"
#include "model/scene/scene.h"

namespace tact::firmware::admission {

/// A message for people where the tool has a lever and the device no torque; else empty.
std::string torque_note(const model::scene::Scene& scene, const hal::DeviceInfo& device);

}  // namespace tact::firmware::admission
