// SPDX-License-Identifier: Apache-2.0
// calculix.h - one elastic body under a load, solved by the program CalculiX (ccx).
//
// The body's elements are C3D10, isotropic linear elastic. Moved nodes have their own axes: x along
// `direction`. With large strain (NLGEOM) the material is neo-Hookean with the same E and nu at
// small strain:
//
//     W = C10 (I1' - 3) + (J - 1)^2 / D1,   C10 = G / 2, D1 = 2 / K        (CalculiX manual 6.8)
//
// with G = E / (2 (1 + nu)), K = E / (3 (1 - 2 nu)). Either nodes are moved by known ways, or a
// rigid ball comes and what touches it is found. Needs ccx 2.20 (Debian: calculix-ccx).
// Source: G. Dhondt, The Finite Element Method for Three-Dimensional Thermomechanical
// Applications, Wiley 2004.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/fem/elasticity.h"
#include "model/fem/tet_mesh.h"
#include "model/mesh/mesh.h"
#include "model/result.h"

namespace tact::tools::reference {

using model::fem::Elasticity;

/// A node and how far it goes.
struct MovedNode {
  std::uint32_t node = 0;
  double along_m = 0.0;  // along the direction of the load
};

/// A rigid frictionless ball that goes along the direction of the load.
struct BallContact {
  double radius_m = 0.0;
  model::Vec3 centre_m{};  // before it moves
  double along_m = 0.0;
  std::vector<model::contact::TriangleCorners> face;  // that it may touch, by their corners
};

struct ElasticLoad {
  model::Vec3 direction{};       // unit
  std::vector<MovedNode> moved;  // not held ones
  bool sideways_held = false;    // of the moved nodes: a bond; else they slide without friction
  bool large_strain = false;
  std::optional<BallContact> ball{};  // needs large strain, and some nodes held
};

struct ElasticProblem {
  const model::fem::TetMesh* body = nullptr;
  Elasticity material{};
  std::vector<std::uint32_t> held;  // do not move at all
  ElasticLoad load{};
  std::vector<std::uint32_t> reported;  // whose displacement is wanted
};

struct ElasticAnswer {
  model::Vec3 force_N{};                    // that moves the moved nodes, or the ball
  std::vector<model::Vec3> moved_force_N;   // of each moved node, in their order
  std::vector<model::Vec3> displacement_m;  // of the reported nodes, in their order
};

/// Solves on one core. On failure the folder with deck and log stays, and the error says where.
model::Result<ElasticAnswer> solve_with_calculix(const ElasticProblem& problem);

/// Did CalculiX run and give up? Anything else is a fault of the machine.
bool found_no_solution(const model::Error& error);

/// "2.20", of the ccx in PATH.
model::Result<std::string> calculix_version();

}  // namespace tact::tools::reference
