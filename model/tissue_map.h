// tissue_map.h - a scene's compliance map: read, checked against its organ, and what it says of
// each vertex.
//
//     factor(v) = F_v(d) / median of F_v(d)      how much stiffer vertex v is at the depth d
//
// Set-up code only.
#pragma once

#include <vector>

#include "model/compliance_family.h"
#include "model/compliance_map.h"
#include "model/result.h"
#include "model/scene.h"

namespace tact::model {

/// The error says what the map lacks and how to make it.
Result<ComplianceMap> read_scene_map(const Scene& scene);

/// The scene's organ under its tool's tip, which must be the same on every sphere.
Result<ComplianceFamily> read_scene_family(const Scene& scene);

/// Of each vertex, from its coordinate in the family; depth below 0: pulled.
std::vector<float> stiffness_factors(const ComplianceFamily& family,
                                     const std::vector<float>& coordinate, double depth_m);

}  // namespace tact::model
