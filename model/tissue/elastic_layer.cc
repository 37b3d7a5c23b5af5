// SPDX-License-Identifier: Apache-2.0
#include "model/tissue/elastic_layer.h"

#include <math.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "model/contact/tangent.h"

namespace tact::model::tissue {
namespace {

// Of the integrals: beyond, phi and psi are 1 to the last bits of a double. The step is small
// enough for J_0 at the outermost ring over the thinnest layer.
constexpr double kEnd = 20.0;
constexpr int kSteps = 20'000;
constexpr std::size_t kRings = 20;

/// LY-1, minus 1; sign -1: phi, +1: psi.
double beyond_half_space(double s, double poisson_ratio, double sign) {
  const double k = 3.0 - 4.0 * poisson_ratio;
  return (2.0 * k * std::sinh(2.0 * s) + sign * 4.0 * s) /
             (2.0 * k * std::cosh(2.0 * s) + 1.0 + k * k + 4.0 * s * s) -
         1.0;
}

/// By the midpoint rule: of (phi - 1) or (psi - 1) times J_0(s rho / h).
double integral(double poisson_ratio, double sign, double distance_ratio) {
  constexpr double kStep = kEnd / kSteps;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double s = (i + 0.5) * kStep;
    sum += beyond_half_space(s, poisson_ratio, sign) * ::j0(s * distance_ratio);
  }
  return sum * kStep;
}

}  // namespace

ComplianceMap layer_map(const ElasticLayer& layer, const contact::SurfaceView& surface,
                        double ring_pitch_m) {
  const double nu = layer.poisson_ratio, h_m = layer.thickness_m;
  const double normal_per_m = (1.0 - nu * nu) / (std::numbers::pi * h_m);
  // LY-3  s1 E = s2 E = (1 + nu) / (2 pi h) ((1 - nu) integral of (psi(s) - 1) ds - ln 2)
  const double sideways_times_E_per_m = (1.0 + nu) / (2.0 * std::numbers::pi * h_m) *
                                        ((1.0 - nu) * integral(nu, 1.0, 0.0) - std::numbers::ln2);
  std::vector<float> ring;
  for (std::size_t j = 0; j <= kRings; ++j)
    ring.push_back(static_cast<float>(
        normal_per_m * integral(nu, -1.0, static_cast<double>(j) * ring_pitch_m / h_m)));

  ComplianceMap map;
  map.poisson_ratio = nu;
  map.ring_pitch_m = ring_pitch_m;
  map.rings = kRings;
  const auto side = static_cast<float>(sideways_times_E_per_m);
  for (const Vec3& normal : surface.vertex_normal) {
    const Vec3 axis = contact::axes_of(normal).unit[0];
    map.regular_times_E_per_m.push_back(ring[0]);
    map.sideways_times_E_per_m.push_back(
        {.s1 = side,
         .s2 = side,
         .axis = {static_cast<float>(axis.x), static_cast<float>(axis.y),
                  static_cast<float>(axis.z)}});
    map.ring_times_E_per_m.insert(map.ring_times_E_per_m.end(), ring.begin() + 1, ring.end());
  }
  return map;
}

}  // namespace tact::model::tissue
