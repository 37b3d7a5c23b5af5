// SPDX-License-Identifier: Apache-2.0
#include "tools/ground_truth/linear_places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tact::tools::ground_truth::linear_places_test {

ToolPoint place(std::optional<std::uint32_t> vertex, const std::vector<double>& force_N) {
  ToolPoint out;
  out.vertex = vertex;
  out.point_m = {1e-3 * vertex.value_or(0), 0.0, 0.0};
  out.direction = {0.0, 0.0, -1.0};
  for (std::size_t i = 0; i < force_N.size(); ++i) {
    ToolCase& at = out.cases.emplace_back();
    at.depth_m = 0.001 * static_cast<double>(i + 1);
    at.force_N = force_N[i];
  }
  return out;
}

ToolReference reference(const std::vector<ToolPoint>& places) {
  ToolReference out;
  out.places = places;
  return out;
}

TEST(LinearPlaces, ALinearPlaceThatFiniteStrainContradictsIsDropped) {
  auto linear = reference({place({}, {1.0, 2.0}), place(7, {1.029, 2.0}), place(8, {1.0, 2.062})});
  const auto finite = reference({place(8, {1.0, 2.0}), place(7, {1.0, 2.0})});
  const auto dropped = drop_contradicted(linear, finite);
  ASSERT_TRUE(dropped);
  ASSERT_EQ(dropped->size(), 1u);
  EXPECT_EQ(dropped->front().place, "8");
  EXPECT_EQ(dropped->front().depth_m, 0.002);
  EXPECT_NEAR(dropped->front().linear_error_ratio, 0.031, 1e-12);
  ASSERT_EQ(linear.places.size(), 2u) << "one is not solved at finite strain, one agrees";
  EXPECT_EQ(linear.places[1].vertex, 7u);
}

TEST(LinearPlaces, AnotherTiltWayOrPointIsAnotherPlace) {
  for (const int what : {0, 1, 2}) {
    ToolPoint other = place({}, {2.0, 4.0});
    if (what == 0) other.tilt_deg = 20.0;
    if (what == 1) other.direction = {0.1, 0.0, -std::sqrt(0.99)};
    if (what == 2) other.point_m.x = 0.001;
    auto linear = reference({place({}, {1.0, 2.0}), place(7, {1.0, 2.0})});
    const auto dropped = drop_contradicted(linear, reference({other, place(7, {1.0, 2.0})}));
    ASSERT_TRUE(dropped) << what;
    EXPECT_TRUE(dropped->empty()) << what;
  }
}

TEST(LinearPlaces, WithoutACommonPlaceAndDepthNothingCountsAsChecked) {
  auto linear = reference({place(7, {1.0, 2.0})});
  EXPECT_FALSE(drop_contradicted(linear, reference({place(8, {1.0, 2.0})})));
  ToolPoint deeper = place(7, {1.0});
  deeper.cases[0].depth_m = 0.0015;
  const auto dropped = drop_contradicted(linear, reference({deeper}));
  ASSERT_FALSE(dropped);
  EXPECT_NE(dropped.error().message.find("the same --sites and --depths"), std::string::npos);
}

TEST(LinearPlaces, WithoutAPlaceLeftAnErrorNamesTheOtherCommand) {
  auto linear = reference({place(7, {1.0, 2.0})});
  const auto dropped = drop_contradicted(linear, reference({place(7, {2.0, 4.0})}));
  ASSERT_FALSE(dropped);
  EXPECT_NE(dropped.error().message.find("tact-lab sweep SCENE --reference"), std::string::npos);
}

TEST(LinearPlaces, KeepsWhatEachDepthAllowsOnAnyForces) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> force(0.5, 2.0), off(0.95, 1.05);
  int kept = 0;
  for (int n = 0; n < 1000; ++n) {
    std::vector<double> linear_N, finite_N;
    bool agrees = true;
    for (int i = 0; i < 3; ++i) {
      finite_N.push_back(force(rng));
      linear_N.push_back(finite_N.back() * off(rng));
      agrees = agrees && std::abs(linear_N.back() - finite_N.back()) <= 0.03 * finite_N.back();
    }
    auto linear = reference({place({}, {1.0, 1.0, 1.0}), place(3, linear_N)});
    ASSERT_TRUE(drop_contradicted(linear, reference({place(3, finite_N)})));
    ASSERT_EQ(linear.places.size() == 2, agrees);
    kept += agrees ? 1 : 0;
  }
  EXPECT_GT(kept, 100);
  EXPECT_LT(kept, 900);
}

}  // namespace tact::tools::ground_truth::linear_places_test
