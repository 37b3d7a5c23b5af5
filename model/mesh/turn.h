// SPDX-License-Identifier: Apache-2.0
// turn.h - a surface turned about its origin. Set-up code only.
#pragma once

#include "model/mesh/mesh.h"
#include "model/types.h"

namespace tact::model::mesh {

/// Vertices and normals; a triangle keeps its corners and neighbours.
void turn(SurfaceMesh& mesh, const Quat& by);

/// Unit rotation of an axis times an angle, degrees.
Quat turn_of(const Vec3& rotation_deg);
/// The same the other way round, 0 to 180 degrees.
Vec3 rotation_deg_of(const Quat& turn);

/// The least turn that brings one unit vector to another; of opposite ones, about any axis across.
Quat turn_between(const Vec3& from, const Vec3& to);

}  // namespace tact::model::mesh
