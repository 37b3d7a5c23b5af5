// SPDX-License-Identifier: Apache-2.0
// notes.h - what a person should know of scene and device, though it hinders nothing.
#pragma once

#include <string>

#include "hal/device.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"

namespace tact::firmware::admission {

// Each a message for people, with the remedy or the keys to change; or empty.

/// The strokes of the hand close the jaws, and neither device nor lines have anything to close them
/// with: what the scene grips, pulls or tears cannot be felt.
bool cannot_grip(const model::scene::Scene& scene, const hal::DeviceInfo& device);
std::string grip_note(const model::scene::Scene& scene, const hal::DeviceInfo& device);

/// The hand's own strokes press so fast that the inertia of tissue, which the law leaves out, would
/// be felt (IN-2). Not for a law that has masses.
std::string inertia_note(const model::scene::Scene& scene, const model::scene::TissueLaw& law);

/// The surface of the organ is open: the number of its boundary edges, and the rule of contact
/// beside them (model/contact/triangle_tree.h).
std::string open_organ_note(const model::scene::Scene& scene);

/// The organ is a hundred times too large or too small for the workspace, or no stroke of the hand
/// brings a sphere of the tool to its surface.
std::string reach_note(const model::scene::Scene& scene);

/// The tool has a lever and the device no torque.
std::string torque_note(const model::scene::Scene& scene, const hal::DeviceInfo& device);

}  // namespace tact::firmware::admission
