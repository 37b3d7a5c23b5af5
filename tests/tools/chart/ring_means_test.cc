// SPDX-License-Identifier: Apache-2.0
#include "tools/chart/measure/ring_means.h"

#include <gtest/gtest.h>

#include "tests/support/shapes.h"

namespace tact::tools::chart::ring_means_test {

using model::Vec3;

TEST(RingMeans, RingMeansOfAConeAreItsHeights) {
  const model::mesh::SurfaceMesh plate = tests::make_plate(0.08, 80);
  RingMeans means(31, 1e-3, 1.0);
  for (const auto& t : plate.triangle) {
    std::array<Vec3, 3> p{};
    std::array<double, 3> rho_m{}, height{};
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = plate.vertex_m[t[k]];
      rho_m[k] = norm(p[k]);
      // The tilt 5 x averages out round each ring.
      height[k] = 1.0 - rho_m[k] / 0.04 + 5.0 * p[k].x;
    }
    means.add_triangle(p, rho_m, height);
  }
  const std::vector<double> rings = means.means();
  ASSERT_EQ(rings.size(), 31U);
  EXPECT_EQ(rings[0], 1.0);
  for (std::size_t k = 1; k < 31; ++k)
    EXPECT_NEAR(rings[k], 1.0 - static_cast<double>(k) / 40.0, 2e-3) << k;
}

TEST(RingMeans, ARingOffTheSurfaceIsAsTheOneBefore) {
  RingMeans means(4, 1.0, 7.0);
  means.add_triangle({Vec3{0, 0, 0}, {1.5, 0, 0}, {0, 1.5, 0}}, {0.0, 1.5, 1.5}, {3.0, 3.0, 3.0});
  EXPECT_EQ(means.means(), (std::vector<double>{7.0, 3.0, 3.0, 3.0}));
}

}  // namespace tact::tools::chart::ring_means_test
