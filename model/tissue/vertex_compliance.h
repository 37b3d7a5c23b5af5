// SPDX-License-Identifier: Apache-2.0
// vertex_compliance.h - the compliance map as one symmetric tensor at each vertex, and its slope
// along the surface, for the smooth surface of contact. Set-up code only.
//
// Value and slope are those of the map and of a plane through two rings of vertices; then they are
// fitted to each other by least squares, with a weight on every change, as SF-3 and SF-4 need it:
//
//     SF-6   G_j - G_i = (dG_i + dG_j) . (x_j - x_i) / 2        over every edge
#pragma once

#include <span>
#include <vector>

#include "model/contact/smooth_surface.h"
#include "model/tissue/compliance_map.h"

namespace tact::model::tissue {

struct VertexComplianceParameters {
  double reach_m = 0.004;  // of the Gaussian weight of the plane
  int sweeps = 40;
  double value_weight_ratio = 5.0;   // of (change of G / mean edge)^2
  double slope_weight_ratio = 0.02;  // of (change of dG)^2
  double min_normal_times_E_per_m = 0.0, min_sideways_times_E_per_m = 0.0;
};

/// One for each vertex of `mesh`, whose map it is; `corner` as fair_corners() makes it.
std::vector<contact::VertexCompliance> vertex_compliance(
    const ComplianceMap& map, const contact::SurfaceView& mesh,
    std::span<const contact::SurfaceCorner> corner, const VertexComplianceParameters& p);

}  // namespace tact::model::tissue
