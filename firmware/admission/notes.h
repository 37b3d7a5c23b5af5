// SPDX-License-Identifier: Apache-2.0
// notes.h - messages about scene and device that do not prevent a run.
#pragma once

#include <string>

#include "hal/device.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"

namespace tact::firmware::admission {

// Each returns a message with the remedy or the keys to change, or an empty string.

/// The hand's strokes close the jaws, but neither device nor lines have an input to close them:
/// what the scene grips, pulls or tears cannot be rendered.
bool cannot_grip(const model::scene::Scene& scene, const hal::DeviceInfo& device);
std::string grip_note(const model::scene::Scene& scene, const hal::DeviceInfo& device);

/// The hand's own strokes are so fast that the inertia of tissue, which the law neglects, would be
/// perceptible (IN-2). Empty for a law that has masses.
std::string inertia_note(const model::scene::Scene& scene, const model::scene::TissueLaw& law);

/// The organ's surface is open: the number of its boundary edges, and the contact rule next to them
/// (model/contact/triangle_tree.h).
std::string open_organ_note(const model::scene::Scene& scene);

/// What tact-mesh notes of the organ: parts that share no edge, unless [look] paints them, and
/// normals that were turned.
std::string parts_note(const model::scene::Scene& scene);

/// The organ's size does not fit the workspace, probably by a wrong unit, or no stroke of the hand
/// brings a sphere of the tool to the surface.
std::string reach_note(const model::scene::Scene& scene);

/// The tool has a lever, but the device has no torque.
std::string torque_note(const model::scene::Scene& scene, const hal::DeviceInfo& device);

}  // namespace tact::firmware::admission
