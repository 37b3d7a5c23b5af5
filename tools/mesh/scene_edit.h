// SPDX-License-Identifier: Apache-2.0
// scene_edit.h - a placement in the text of a scene: its own keys, and no other line.
#pragma once

#include <optional>
#include <string>

#include "model/result.h"
#include "tools/mesh/place.h"

namespace tact::tools::mesh {

/// The text of a scene with these values in [organ] and [hand]; all else stays, and that is
/// checked.
model::Result<std::string> placed_in(const std::string& scene_text, const Placement& placement);

/// Into the scene's file, whole or not at all. What place() gave loads.
std::optional<model::Error> write_placement(const std::string& scene_path,
                                            const Placement& placement);

}  // namespace tact::tools::mesh
