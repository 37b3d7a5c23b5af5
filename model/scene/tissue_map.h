// SPDX-License-Identifier: Apache-2.0
// tissue_map.h - a scene's compliance map: read, checked against its organ, and what it says of
// each vertex. Set-up code only.
#pragma once

#include "model/result.h"
#include "model/scene/scene.h"
#include "model/tissue/compliance_family.h"
#include "model/tissue/compliance_map.h"

namespace tact::model::scene {

/// The error says what the map lacks and how to make it.
Result<tissue::ComplianceMap> read_scene_map(const Scene& scene);

/// R of the tool's tip; an error where its spheres differ.
Result<double> scene_tip_radius_m(const Scene& scene);

/// The scene's organ under its tool's tip, which must be the same on every sphere, at small strain.
Result<tissue::ComplianceFamily> read_scene_family(const Scene& scene);

}  // namespace tact::model::scene
