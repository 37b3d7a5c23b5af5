// SPDX-License-Identifier: Apache-2.0
// fair_surface.h - makes the corners of the smooth surface from a mesh. Set-up code only.
//
// First each vertex is moved back by the mean height of SF-1 over its triangles, so that the smooth
// organ has the size of the mesh. Then normals and heights are fitted by least squares, with a
// penalty on every change, so that over every edge
//
//     SF-5   (n_i + n_j) . (x_j - x_i) = 0
//
// SF-1 then has n . dx = 0 up to the third order of the angle between the corners' normals.
#pragma once

#include <cstdint>
#include <vector>

#include "model/contact/smooth_surface.h"

namespace tact::model::contact {

struct FairParameters {
  int sweeps = 60;
  double turn_weight_ratio = 0.1;    // of (change of the normal)^2
  double height_weight_ratio = 0.3;  // of (change of the height / mean edge)^2
};

std::vector<SurfaceCorner> fair_corners(const SurfaceView& mesh, const FairParameters& p = {});

/// The vertices that share an edge with v.
std::vector<std::uint32_t> neighbours_of(const SurfaceView& mesh, std::uint32_t v);

/// Two unit vectors across a normal; with it they form a right-handed system.
std::array<Vec3, 2> axes_across(const Vec3& normal);

}  // namespace tact::model::contact
