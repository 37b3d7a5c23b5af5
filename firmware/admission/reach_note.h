// SPDX-License-Identifier: Apache-2.0
// reach_note.h - does the simulated hand touch the organ, and is the organ as large as an organ?
#pragma once

#include <string>

#include "model/scene/scene.h"

namespace tact::firmware::admission {

/// A message for people where the organ is a hundred times too large or too small for the
/// workspace, or where no stroke of the hand brings a sphere of the tool to its surface; else
/// empty. It names the keys to change.
std::string reach_note(const model::scene::Scene& scene);

}  // namespace tact::firmware::admission
