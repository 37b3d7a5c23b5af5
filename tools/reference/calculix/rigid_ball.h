// SPDX-License-Identifier: Apache-2.0
// rigid_ball.h - a ball as a shell of quadratic wedges: the tool's side of a contact.
//
// Its outer faces have six nodes on the sphere, so that it is round to 1e-4 of its radius and its
// normal turns smoothly. What looks back from the tissue by more than 30 degrees is left out.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/mesh/mesh.h"

namespace tact::tools::reference {

/// Of a C3D15 (CalculiX manual 6.2): inner corners, outer corners, middles of the inner edges, of
/// the outer edges, of the spokes. Its face 2 is the outer one.
using WedgeNodes = std::array<std::uint32_t, 15>;

struct RigidBall {
  std::vector<model::Vec3> node_m;
  std::vector<WedgeNodes> wedge;
};

/// Centre at the origin, its pole along +x.
RigidBall make_rigid_ball(double radius_m);

}  // namespace tact::tools::reference
