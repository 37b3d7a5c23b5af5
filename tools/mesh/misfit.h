// SPDX-License-Identifier: Apache-2.0
// misfit.h - what in a scene was made for the organ that it had before, and no longer fits.
//
// Placing an organ writes where it lies. What was measured on the one before, by hand or by minutes
// of finite elements, is told and left to the user.
#pragma once

#include <string>
#include <vector>

#include "model/scene/scene.h"

namespace tact::tools::mesh {

struct Misfit {
  std::string keys;  // of the scene
  std::string text;  // why they do not fit, and what to write or run
};

/// `before`: the scene as it was; null if it does not load. `after`: with the organ in its place.
std::vector<Misfit> misfits_of(const model::scene::Scene* before, const model::scene::Scene& after);

}  // namespace tact::tools::mesh
