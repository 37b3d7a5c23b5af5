// SPDX-License-Identifier: Apache-2.0
// grip_note.h - does the scene grip, and can the hand close the jaws on this device?
#pragma once

#include <string>

#include "hal/device.h"
#include "model/scene/scene.h"

namespace tact::firmware::admission {

/// The strokes of the hand close the jaws, and neither device nor lines have anything to close them
/// with: what the scene grips, pulls or tears cannot be felt.
bool cannot_grip(const model::scene::Scene& scene, const hal::DeviceInfo& device);
/// The same as a message for people, with the remedy; or empty.
std::string grip_note(const model::scene::Scene& scene, const hal::DeviceInfo& device);

}  // namespace tact::firmware::admission
