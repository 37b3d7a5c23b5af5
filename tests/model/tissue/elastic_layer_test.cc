// SPDX-License-Identifier: Apache-2.0
#include "model/tissue/elastic_layer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/units.h"
#include "tests/support/shapes.h"

namespace tact::model::tissue::elastic_layer_test {

ComplianceMap of(double thickness_m, double poisson_ratio, double ring_pitch_m = 2_mm) {
  static const mesh::SurfaceMesh plate = tests::make_plate(0.08, 4);
  return layer_map({thickness_m, poisson_ratio}, plate.view(), ring_pitch_m);
}

// Dimitriadis et al. (2002), eq. 15, a fit of theirs; r E = alpha (1 - nu^2) / (pi h).
TEST(ElasticLayer, HasThePublishedConstantOfABondedLayer) {
  for (const double nu : {0.3, 0.4, 0.45, 0.49, 0.5}) {
    const double alpha = -(1.2876 - 1.4678 * nu + 1.3442 * nu * nu) / (1.0 - nu);
    const double must_per_m = alpha * (1.0 - nu * nu) / (std::numbers::pi * 30_mm);
    EXPECT_NEAR(static_cast<double>(of(30_mm, nu).regular_times_E_per_m[0]) / must_per_m, 1.0, 0.01)
        << nu;
  }
}

// Far away a bonded layer is at rest: there g cancels the half-space, (1 - nu^2) / (pi rho E).
TEST(ElasticLayer, RingsCancelTheHalfSpaceFarAway) {
  const ComplianceMap map = of(4_mm, 0.45);
  for (std::size_t j = 8; j <= map.rings; ++j) {
    const double rho_m = static_cast<double>(j) * map.ring_pitch_m;
    const double half_space_per_m = (1.0 - 0.45 * 0.45) / (std::numbers::pi * rho_m);
    EXPECT_NEAR(static_cast<double>(map.ring_times_E_per_m[j - 1]) / half_space_per_m, -1.0, 0.02)
        << rho_m;
  }
}

TEST(ElasticLayer, IsTheStifferTheThinnerAndOneEverywhere) {
  const ComplianceMap thick = of(40_mm, 0.45), thin = of(10_mm, 0.45);
  EXPECT_NEAR(static_cast<double>(thin.regular_times_E_per_m[0] / thick.regular_times_E_per_m[0]),
              4.0, 1e-4);
  for (std::size_t v = 0; v < thick.vertices(); ++v) {
    EXPECT_EQ(thick.regular_times_E_per_m[v], thick.regular_times_E_per_m[0]);
    EXPECT_LT(thick.sideways_times_E_per_m[v].s1, 0.0F);
    EXPECT_EQ(thick.sideways_times_E_per_m[v].s1, thick.sideways_times_E_per_m[v].s2);
  }
}

// Shear of an incompressible layer: (1 + nu) / (2 pi h) (-(1 - nu) ln 2 - ln 2), in closed form.
TEST(ElasticLayer, SidewaysOfAnIncompressibleLayerIsClosed) {
  const double must_per_m = -1.5 * 1.5 * std::numbers::ln2 / (2.0 * std::numbers::pi * 30_mm);
  EXPECT_NEAR(static_cast<double>(of(30_mm, 0.5).sideways_times_E_per_m[0].s1) / must_per_m, 1.0,
              1e-5);
}

}  // namespace tact::model::tissue::elastic_layer_test
