// SPDX-License-Identifier: Apache-2.0
// surface_rays.h - where a straight way meets a closed triangle surface.
//
// Source: T. Moeller, B. Trumbore, J. Graphics Tools 2 (1997) 21.
#pragma once

#include <optional>

#include "model/mesh/mesh.h"

namespace tact::tools::reference {

class SurfaceRays {
 public:
  /// `surface` outlives it.
  explicit SurfaceRays(const model::mesh::SurfaceMesh& surface) : surface_(surface) {}

  struct Meeting {
    double away_m = 0.0;   // to where the way first goes in; below 0: the start lies inside
    double thick_m = 0.0;  // from there to where it comes out
  };
  /// `direction` is a unit vector. Nothing if the way does not go through the surface.
  std::optional<Meeting> thickness(const model::Vec3& from_m, const model::Vec3& direction) const;

 private:
  const model::mesh::SurfaceMesh& surface_;
};

}  // namespace tact::tools::reference
