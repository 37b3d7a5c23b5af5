// SPDX-License-Identifier: Apache-2.0
// elasticity.h - stiffness of an isotropic linear elastic body of quadratic tetrahedra.
//
//     K_ai,bj = integral of  lambda N_a,i N_b,j + mu (N_a,j N_b,i + delta_ij N_a,k N_b,k)  dV
//     lambda  = E nu / ((1 + nu)(1 - 2 nu)),   mu = G = E / (2 (1 + nu))
//
//     E   Young's modulus, Pa      nu   Poisson ratio      N_a   shape function of node a
//
// Four Gauss points an element: exact where its edges are straight [Zienkiewicz, Taylor, The Finite
// Element Method, 5th ed., vol. 1, 8.8 and table 8.3]. Small strain: forces are linear in
// displacements. Offline only.
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

#include "model/fem/tet_mesh.h"
#include "model/result.h"

namespace tact::model::fem {

/// A ball of the same material with another modulus; a Gauss point lies in it or not.
struct Lump {
  Vec3 center_m;
  double radius_m = 0.0, modulus_ratio = 1.0;
};

struct Elasticity {
  double youngs_modulus_Pa = 0.0;  // E, > 0
  double poisson_ratio = 0.0;      // nu, from 0 to below 0.5; close to it quadratic tetrahedra lock
  std::vector<Lump> lumps{};

  double shear_modulus_Pa() const { return youngs_modulus_Pa / (2.0 * (1.0 + poisson_ratio)); }
  /// E* = E / (1 - nu^2), of a half-space under a frictionless tool.
  double contact_modulus_Pa() const {
    return youngs_modulus_Pa / (1.0 - poisson_ratio * poisson_ratio);
  }
};

/// Three unknowns a free node, numbered in the order of the nodes.
struct FreeNodes {
  static constexpr std::int32_t kFixed = -1;
  std::vector<std::int32_t> first_unknown;  // of each node, or kFixed
  std::int32_t unknowns = 0;
};
/// `fixed`: nodes that do not move, in any order, repeated or not.
FreeNodes free_nodes(std::size_t nodes, const std::vector<std::uint32_t>& fixed);

using StiffnessMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, std::int32_t>;

/// Lower triangle of K over the free nodes, N/m. An error for a material without meaning or an
/// element without volume.
Result<StiffnessMatrix> assemble_stiffness(const TetMesh& mesh, const Elasticity& material,
                                           const FreeNodes& free);

}  // namespace tact::model::fem
