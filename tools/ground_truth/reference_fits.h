// SPDX-License-Identifier: Apache-2.0
// reference_fits.h - is this reference about this scene? A residual against another organ means
// nothing.
#pragma once

#include <optional>

#include "model/scene/scene.h"
#include "tools/ground_truth/reference_data.h"
#include "tools/ground_truth/tool_reference.h"

namespace tact::tools::ground_truth {

/// Whether Young's modulus must be the scene's; a fit may look for it.
enum class ModulusOf { kSame, kAny };

/// The tip's radius, the sites' places, and, where the scene has [elastic], its numbers. An error
/// names the first that differs and how to solve the reference again.
std::optional<model::Error> check_reference_fits(const ReferenceData& reference,
                                                 const model::scene::Scene& scene,
                                                 ModulusOf modulus);
/// All spheres of the tool, the places' vertices, the hand's site, and [elastic].
std::optional<model::Error> check_tool_reference_fits(const ToolReference& reference,
                                                      const model::scene::Scene& scene);

/// The tool at a place, its lowest point `depth_m` beyond it.
model::Tool tool_at(const model::scene::Scene& scene, const ToolPoint& place, double depth_m);

}  // namespace tact::tools::ground_truth
