// SPDX-License-Identifier: Apache-2.0
// inertia_note.h - do the strokes of the hand need the inertia that the law leaves out?
#pragma once

#include <string>

#include "model/scene/scene.h"
#include "model/scene/tissue.h"

namespace tact::firmware::admission {

/// A message for people where the hand's own strokes press so fast that the inertia of tissue,
/// which the law leaves out, would be felt (IN-2); empty where they do not, or the law has masses.
std::string inertia_note(const model::scene::Scene& scene, const model::scene::TissueLaw& law);

}  // namespace tact::firmware::admission
