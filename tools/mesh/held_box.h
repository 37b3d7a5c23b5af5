// SPDX-License-Identifier: Apache-2.0
// held_box.h - the box of [elastic] in which the organ is held, and a first guess of it.
//
// Both in the frame of the turned mesh, as elastic.fixed_min_m and fixed_max_m are.
#pragma once

#include <cstddef>

#include "model/mesh/mesh.h"

namespace tact::tools::mesh {

struct HeldBox {
  model::Vec3 min_m{}, max_m{};

  /// Its sides included.
  bool holds(const model::Vec3& p_m) const;
};

/// The tenth of the organ that lies farthest along the axis nearest to `inward`.
HeldBox far_tenth(const model::mesh::SurfaceMesh& organ, const model::Vec3& inward);

/// Triangles whose three corners lie in the box.
std::size_t held_triangles(const model::mesh::SurfaceMesh& organ, const HeldBox& box);

}  // namespace tact::tools::mesh
