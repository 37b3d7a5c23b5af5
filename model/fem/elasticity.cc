// SPDX-License-Identifier: Apache-2.0
#include "model/fem/elasticity.h"

#include <Eigen/Dense>
#include <array>
#include <string>

namespace tact::model::fem {
namespace {

using Gradients = Eigen::Matrix<double, 10, 3>;          // dN_a / dx_i, 1/m
using ElementStiffness = Eigen::Matrix<double, 30, 30>;  // row 3 a + i

// (5 + 3 sqrt(5))/20 and (5 - sqrt(5))/20
constexpr double kFar = 0.5854101966249685, kNear = 0.1381966011250105;

/// dN_a / dL_i at the barycentric point L, where L_0 = 1 - L_1 - L_2 - L_3.
Gradients reference_gradients(const std::array<double, 4>& l) {
  Eigen::Matrix<double, 4, 3> dl;  // dL / d(L_1, L_2, L_3)
  dl << -1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  Gradients g;
  // N_a = L_a (2 L_a - 1) at a corner, 4 L_p L_q in the middle of the edge p q
  for (std::size_t a = 0; a < 4; ++a)
    g.row(static_cast<int>(a)) = (4.0 * l[a] - 1.0) * dl.row(static_cast<int>(a));
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [p, q] = kTetEdge[e];
    g.row(static_cast<int>(4 + e)) =
        4.0 * (l[p] * dl.row(static_cast<int>(q)) + l[q] * dl.row(static_cast<int>(p)));
  }
  return g;
}

/// Reference gradients at the four Gauss points; each weighs 1/24.
const std::array<Gradients, 4>& gauss_gradients() {
  static const std::array<Gradients, 4> points = [] {
    std::array<Gradients, 4> out;
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<double, 4> l{kNear, kNear, kNear, kNear};
      l[k] = kFar;
      out[k] = reference_gradients(l);
    }
    return out;
  }();
  return points;
}

/// Is every middle node nearer to the middle of its edge than a quarter of the edge?
bool middles_in_order(const TetMesh& mesh, const TetNodes& nodes) {
  for (std::size_t e = 0; e < kTetEdge.size(); ++e) {
    const Vec3 &p = mesh.node_m[nodes[kTetEdge[e][0]]], &q = mesh.node_m[nodes[kTetEdge[e][1]]];
    // Chosen: curved edges pass; another order of the nodes puts a middle on a wrong edge.
    if (!(norm(mesh.node_m[nodes[4 + e]] - 0.5 * (p + q)) < 0.25 * norm(p - q))) return false;
  }
  return true;
}

double modulus_ratio(const std::vector<Lump>& lumps, const Vec3& at_m) {
  double ratio = 1.0;
  for (const Lump& lump : lumps)
    if (norm(at_m - lump.center_m) <= lump.radius_m) ratio = lump.modulus_ratio;
  return ratio;
}

/// False if the element has no positive volume at a Gauss point.
bool element_stiffness(const TetMesh& mesh, const TetNodes& nodes, const Elasticity& material,
                       ElementStiffness& k) {
  const double nu = material.poisson_ratio, mu_Pa = material.shear_modulus_Pa();
  const double lambda_Pa = material.youngs_modulus_Pa * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
  Gradients x;
  for (int a = 0; a < 10; ++a) {
    const Vec3& p = mesh.node_m[nodes[static_cast<std::size_t>(a)]];
    x.row(a) << p.x, p.y, p.z;
  }
  k.setZero();
  for (std::size_t point = 0; point < 4; ++point) {
    const Gradients& reference = gauss_gradients()[point];
    Vec3 at_m;
    for (std::size_t c = 0; c < 4; ++c) at_m += (c == point ? kFar : kNear) * mesh.node_m[nodes[c]];
    const Eigen::Matrix3d jacobian = x.transpose() * reference;  // dx_i / dL_j
    if (!(jacobian.determinant() > 0.0)) return false;
    const double volume_m3 = modulus_ratio(material.lumps, at_m) * jacobian.determinant() / 24.0;
    const Gradients g = reference * jacobian.inverse();
    const Eigen::Matrix<double, 10, 10> dots = volume_m3 * mu_Pa * (g * g.transpose());
    for (Eigen::Index a = 0; a < 10; ++a)
      for (Eigen::Index b = 0; b < 10; ++b) {
        // lambda N_a,i N_b,j + mu (N_a,j N_b,i + delta_ij N_a,k N_b,k)
        k.block<3, 3>(3 * a, 3 * b) += volume_m3 * (lambda_Pa * g.row(a).transpose() * g.row(b) +
                                                    mu_Pa * g.row(b).transpose() * g.row(a));
        for (Eigen::Index i = 0; i < 3; ++i) k(3 * a + i, 3 * b + i) += dots(a, b);
      }
  }
  return true;
}

}  // namespace

FreeNodes free_nodes(std::size_t nodes, const std::vector<std::uint32_t>& fixed) {
  FreeNodes out{.first_unknown = std::vector<std::int32_t>(nodes, 0)};
  for (const std::uint32_t node : fixed) out.first_unknown[node] = FreeNodes::kFixed;
  for (std::int32_t& first : out.first_unknown) {
    if (first == FreeNodes::kFixed) continue;
    first = out.unknowns;
    out.unknowns += 3;
  }
  return out;
}

Result<StiffnessMatrix> assemble_stiffness(const TetMesh& mesh, const Elasticity& material,
                                           const FreeNodes& free) {
  const double e_Pa = material.youngs_modulus_Pa, nu = material.poisson_ratio;
  if (!(e_Pa > 0.0 && std::isfinite(e_Pa)))
    return Error{"finite elements: youngs_modulus_Pa must be finite and above 0"};
  if (!(nu >= 0.0 && nu < 0.5))
    return Error{
        "finite elements: poisson_ratio must be 0 or more and below 0.5; 0.49 is usual for "
        "tissue that keeps its volume"};
  std::vector<Eigen::Triplet<double, std::int32_t>> entries;
  // 30 x 31 / 2: the lower triangle of an element.
  entries.reserve(mesh.element.size() * 465);
  ElementStiffness k;
  for (std::size_t e = 0; e < mesh.element.size(); ++e) {
    const TetNodes& nodes = mesh.element[e];
    if (!middles_in_order(mesh, nodes))
      return Error{"finite elements: the middle nodes of element " + std::to_string(e) +
                   " (counted from 0) do not lie in the order of tet_mesh.h"};
    if (!element_stiffness(mesh, nodes, material, k))
      return Error{"finite elements: element " + std::to_string(e) +
                   " (counted from 0) is inside out or flat; mesh the body again, finer"};
    for (int r = 0; r < 30; ++r)
      for (int c = 0; c < 30; ++c) {
        const std::int32_t row = free.first_unknown[nodes[static_cast<std::size_t>(r / 3)]];
        const std::int32_t col = free.first_unknown[nodes[static_cast<std::size_t>(c / 3)]];
        // K u = f of the free nodes alone: fixed ones do not move, so their columns add nothing.
        if (row == FreeNodes::kFixed || col == FreeNodes::kFixed) continue;
        if (row + r % 3 >= col + c % 3) entries.emplace_back(row + r % 3, col + c % 3, k(r, c));
      }
  }
  StiffnessMatrix matrix(free.unknowns, free.unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace tact::model::fem
