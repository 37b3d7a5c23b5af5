// SPDX-License-Identifier: Apache-2.0
#include "model/fem/hertz_load.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace tact::model::fem {
namespace {

constexpr int kCuts = 8;  // a triangle is cut into kCuts^2 for the integral of p N_a

Vec3 point_of(const TetMesh& mesh, const FaceNodes& f, const std::array<double, 3>& l) {
  return l[0] * mesh.node_m[f[0]] + l[1] * mesh.node_m[f[1]] + l[2] * mesh.node_m[f[2]];
}

/// Calls visit(barycentric middle) for each of kCuts^2 equal parts.
template <typename Visit>
void for_each_part(const Visit& visit) {
  // Of each cell of the grid one triangle stands up, and all but the last have one upside down.
  constexpr double kStep = 1.0 / kCuts;
  for (int i = 0; i < kCuts; ++i)
    for (int j = 0; j < kCuts - i; ++j) {
      const double a = (i + 1.0 / 3.0) * kStep, b = (j + 1.0 / 3.0) * kStep;
      visit(std::array<double, 3>{1.0 - a - b, a, b});
      if (j == kCuts - i - 1) continue;
      const double c = (i + 2.0 / 3.0) * kStep, d = (j + 2.0 / 3.0) * kStep;
      visit(std::array<double, 3>{1.0 - c - d, c, d});
    }
}

bool is_near(const TetMesh& mesh, const FaceNodes& f, const Vec3& centre, double radius_m) {
  // Does the disc reach the triangle? Corners and middles of edges decide: patches are wider.
  return std::any_of(f.begin(), f.end(), [&](std::uint32_t node) {
    return norm(mesh.node_m[node] - centre) < radius_m;
  });
}

// The patch, grown from triangle to triangle: over the rim of a thin lobe it would reach the far
// side only by walking there.
std::vector<std::uint32_t> faces_near(const TetMesh& mesh, const Boundary& boundary,
                                      std::uint32_t centre, double radius_m) {
  std::vector<std::uint32_t> found = boundary.faces_of_node[centre];
  // Sorted, to look up in; found keeps the order and is the queue of the walk.
  std::vector<std::uint32_t> known = found;
  std::sort(known.begin(), known.end());
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const std::uint32_t node : boundary.face[found[i]])
      for (const std::uint32_t next : boundary.faces_of_node[node]) {
        const auto at = std::lower_bound(known.begin(), known.end(), next);
        if (at != known.end() && *at == next) continue;
        if (!is_near(mesh, boundary.face[next], mesh.node_m[centre], radius_m)) continue;
        known.insert(at, next);
        found.push_back(next);
      }
  return found;
}

}  // namespace

std::vector<NodeWeight> hertz_weights(const TetMesh& mesh, const Boundary& boundary,
                                      std::uint32_t centre, double radius_m) {
  std::map<std::uint32_t, double> weight;
  double sum = 0.0;
  const Vec3 middle = mesh.node_m[centre];
  for (const std::uint32_t face : faces_near(mesh, boundary, centre, radius_m)) {
    const FaceNodes& f = boundary.face[face];
    const Vec3& o = mesh.node_m[f[0]];
    const double area_m2 =
        norm(cross(mesh.node_m[f[1]] - o, mesh.node_m[f[2]] - o)) / (2.0 * kCuts * kCuts);
    for_each_part([&](const std::array<double, 3>& l) {
      const double ratio = norm(point_of(mesh, f, l) - middle) / radius_m;
      if (ratio >= 1.0) return;
      // Hertz; its factor falls out where the weights are made to sum to 1.
      const double p = std::sqrt(1.0 - ratio * ratio) * area_m2;
      sum += p;
      for (std::size_t i = 0; i < 3; ++i) {
        // N_a = L (2 L - 1) at a corner, 4 L_i L_(i+1) in the middle of an edge. That of a corner
        // is negative near the opposite side, and so may its weight be.
        weight[f[i]] += p * l[i] * (2.0 * l[i] - 1.0);
        weight[f[3 + i]] += p * 4.0 * l[i] * l[(i + 1) % 3];
      }
    });
  }
  std::vector<NodeWeight> out;
  out.reserve(weight.size());
  for (const auto& [node, w] : weight) out.push_back({node, w / sum});
  return out;
}

double hertz_displacement_m_per_N(const Elasticity& material, double radius_m, double rho_m) {
  const double a = radius_m, r = rho_m;
  const double scale = 3.0 / (8.0 * material.contact_modulus_Pa() * a * a * a);
  // u = 3 F (2 a^2 - r^2) / (8 E* a^3)
  if (r <= a) return scale * (2.0 * a * a - r * r);
  // u = (3 F / (4 pi E* a^3)) [(2 a^2 - r^2) asin(a / r) + a sqrt(r^2 - a^2)]
  return scale * 2.0 / std::numbers::pi *
         ((2.0 * a * a - r * r) * std::asin(a / r) + a * std::sqrt(r * r - a * a));
}

// Mean of u over the patch, weighted by the pressure: integral of p u / F.
double hertz_normal_m_per_N(const Elasticity& material, double radius_m) {
  return 3.0 / (5.0 * material.contact_modulus_Pa() * radius_m);
}

// The same for a traction of that shape along the surface: 1/E* is replaced by
// (2 - nu)/(4 mu) (Johnson 3.6), so C_t/C_n = (2 - nu)/(2 (1 - nu)).
double hertz_tangential_m_per_N(const Elasticity& material, double radius_m) {
  return 3.0 * (2.0 - material.poisson_ratio) / (20.0 * material.shear_modulus_Pa() * radius_m);
}

}  // namespace tact::model::fem
