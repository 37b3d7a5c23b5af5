// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/press/contact_radius.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/ground_truth/ring_means.h"
#include "tools/reference/organ/refine_surface.h"

namespace tact::tools::reference {
namespace {

using model::Vec3;

constexpr int kSteps = 200;  // of the integrals, midpoint rule
// At R itself the slope of the gap is infinite.
constexpr double kWidest = 0.999;  // of R

/// Where a rising function is zero between 0 and `high`: halve the interval.
template <typename Function>
double root(double high, const Function& f) {
  double low = 0.0;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

TipContact::TipContact(const Elasticity& material, double sphere_radius_m,
                       std::vector<double> fall_m, double pitch_m)
    : modulus_Pa_(material.contact_modulus_Pa()),
      sphere_radius_m_(sphere_radius_m),
      fall_m_(std::move(fall_m)),
      pitch_m_(pitch_m) {}

double TipContact::gap_slope(double rho) const {
  // g' = rho / sqrt(R^2 - rho^2) + s'
  double slope = rho / std::sqrt(sphere_radius_m_ * sphere_radius_m_ - rho * rho);
  if (fall_m_.size() < 2) return slope;
  // Straight between rings; beyond the last its slope goes on.
  const auto k = std::min(static_cast<std::size_t>(rho / pitch_m_), fall_m_.size() - 2);
  slope += (fall_m_[k + 1] - fall_m_[k]) / pitch_m_;
  return slope;
}

double TipContact::depth_m(double a) const {
  // d0 = a int g'(a sin t) dt
  const double step = 0.5 * std::numbers::pi / kSteps;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) sum += gap_slope(a * std::sin((i + 0.5) * step));
  return a * sum * step;
}

double TipContact::force_N(double a) const {
  // F = 2 E* a^2 int g'(a sin t) sin(t)^2 dt
  const double step = 0.5 * std::numbers::pi / kSteps;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double s = std::sin((i + 0.5) * step);
    sum += gap_slope(a * s) * s * s;
  }
  return 2.0 * modulus_Pa_ * a * a * sum * step;
}

double TipContact::compliance_m_per_N(double solved_depth_m, double solved_force_N) const {
  const double a =
      root(kWidest * sphere_radius_m_, [&](double at) { return force_N(at) - solved_force_N; });
  // d = d0(a) + c F
  return (solved_depth_m - depth_m(a)) / solved_force_N;
}

double TipContact::radius_m(double wanted_m, double compliance_m_per_N) const {
  return root(kWidest * sphere_radius_m_,
              [&](double a) { return depth_m(a) + compliance_m_per_N * force_N(a) - wanted_m; });
}

model::Result<std::vector<double>> surface_fall_m(const model::mesh::SurfaceMesh& surface,
                                                  std::uint32_t vertex, int rings, double pitch_m) {
  const Vec3 at_m = surface.vertex_m[vertex];
  const Circle axis{at_m, -surface.vertex_normal[vertex], 0.0};
  const double reach_m = rings * pitch_m;
  const auto fine = refine_surface({surface.vertex_m, surface.triangle}, {.at_m = at_m,
                                                                          .axis = {},
                                                                          .radius_m = reach_m,
                                                                          .fine_m = pitch_m,
                                                                          .growth = 1.0,
                                                                          .largest_m = 0.0});
  if (!fine) return fine.error();
  ground_truth::RingMeans means(rings, pitch_m, 0.0);
  for (const auto& t : fine->triangle) {
    std::array<Vec3, 3> p{};
    std::array<double, 3> rho{}, fall{};
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = fine->vertex_m[t[k]];
      rho[k] = axis.away_m(p[k]);
      fall[k] = dot(p[k] - at_m, axis.axis);
    }
    const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
    // Another lobe of the organ may face the same way.
    const bool is_near = norm(p[0] - at_m) < 2.0 * reach_m;
    if (is_near && dot(normal, axis.axis) < -ground_truth::kFacing * norm(normal))
      means.add_triangle(p, rho, fall);
  }
  return means.means();
}

}  // namespace tact::tools::reference
