// SPDX-License-Identifier: Apache-2.0
#include "model/tissue/indentation_tilt.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/units.h"
#include "tests/support/shapes.h"

namespace tact::model::tissue::indentation_tilt_test {

/// r E = 40 + 300 x - 100 y, x and y in m; what looks down is as stiff as it can be.
ComplianceMap sloping_map(const mesh::SurfaceMesh& surface) {
  ComplianceMap map;
  for (std::size_t v = 0; v < surface.vertex_m.size(); ++v) {
    const Vec3& at_m = surface.vertex_m[v];
    const bool looks_up = surface.vertex_normal[v].z > 0.0;
    map.regular_times_E_per_m.push_back(
        looks_up ? static_cast<float>(40.0 + 300.0 * at_m.x - 100.0 * at_m.y) : -1000.0F);
  }
  return map;
}

TEST(IndentationTilt, IsHalfTheSlopeOfTheGive) {
  const mesh::SurfaceMesh plate = tests::make_plate(100_mm, 20);
  for (const Vec3& t : indentation_tilt(sloping_map(plate), plate.view())) {
    EXPECT_NEAR(t.x, 150.0, 1e-3);
    EXPECT_NEAR(t.y, -50.0, 1e-3);
    EXPECT_NEAR(t.z, 0.0, 1e-9);
  }
}

TEST(IndentationTilt, TiltDependsOnVerticesWithinItsReachOnly) {
  const mesh::SurfaceMesh plate = tests::make_plate(100_mm, 20);
  const auto nearest = [&](const Vec3& to_m) {
    const auto away_m = [&](const Vec3& at_m) { return norm(at_m - to_m); };
    return static_cast<std::size_t>(std::ranges::min_element(plate.vertex_m, {}, away_m) -
                                    plate.vertex_m.begin());
  };
  const std::size_t middle = nearest({});
  for (const Vec3& way : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}})
    for (const double away_m : {15_mm, 25_mm}) {
      ComplianceMap map = sloping_map(plate);
      map.regular_times_E_per_m[nearest(plate.vertex_m[middle] + away_m * way)] += 100.0F;
      const Vec3 more = indentation_tilt(map, plate.view())[middle] - Vec3{150.0, -50.0, 0.0};
      if (away_m < kTiltReach_m)
        EXPECT_GT(dot(more, way), 10.0);
      else
        EXPECT_NEAR(norm(more), 0.0, 1e-3);
    }
}

TEST(IndentationTilt, DoesNotLookThroughALobe) {
  // The far side, 10 mm below, is another lobe's for all that its vertices are near.
  mesh::SurfaceMesh lobe = tests::make_plate(100_mm, 20);
  const std::size_t upper = lobe.vertex_m.size();
  for (std::size_t v = 0; v < upper; ++v) {
    if (lobe.vertex_m[v].x > 0.0) continue;  // so that it would lean
    lobe.vertex_m.push_back(lobe.vertex_m[v] - Vec3{0, 0, 10_mm});
    lobe.vertex_normal.push_back({0, 0, -1});
  }
  const auto tilt = indentation_tilt(sloping_map(lobe), lobe.view());
  for (std::size_t v = 0; v < upper; ++v) EXPECT_NEAR(tilt[v].x, 150.0, 1e-3);
}

TEST(IndentationTilt, CollinearVerticesHaveZeroTilt) {
  mesh::SurfaceMesh line;
  for (int i = 0; i < 5; ++i) {
    line.vertex_m.push_back({i * 1_mm, 0, 0});
    line.vertex_normal.push_back({0, 0, 1});
  }
  for (const Vec3& t : indentation_tilt(sloping_map(line), line.view())) EXPECT_EQ(t, Vec3{});
}

}  // namespace tact::model::tissue::indentation_tilt_test
