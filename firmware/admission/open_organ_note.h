// SPDX-License-Identifier: Apache-2.0
// open_organ_note.h - has the organ a boundary, and what is not felt there?
#pragma once

#include <string>

#include "model/scene/scene.h"

namespace tact::firmware::admission {

/// A message for people where the surface of the organ is open, with the number of its boundary
/// edges and the rule of contact beside them (model/contact/triangle_tree.h); empty where it is
/// closed.
std::string open_organ_note(const model::scene::Scene& scene);

}  // namespace tact::firmware::admission
