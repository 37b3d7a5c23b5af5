// SPDX-License-Identifier: Apache-2.0
#include "model/contact/proxy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/units.h"
#include "tests/support/no_alloc.h"
#include "tests/support/shapes.h"

namespace tact::model::contact::proxy_test {

constexpr double kTip_m = 4_mm;

/// A sphere's centre that goes from one point to another, 0.1 mm a tick.
struct Walk {
  mesh::SurfaceMesh ball = tests::make_ball(20_mm, 3);
  Vec3 centre_m{0.0, 0.0, 22_mm};
  Proxy proxy;

  Walk() { proxy.restart(follow(ball.view(), 0, centre_m), kTip_m); }
  void to(const Vec3& goal_m, bool is_beyond_the_law = false) {
    while (norm(goal_m - centre_m) > 1e-12) {
      const double way_m = norm(goal_m - centre_m);
      const Vec3 moved_m = std::min(1.0, 0.1_mm / way_m) * (goal_m - centre_m);
      centre_m += moved_m;
      proxy.follow(ball.view(), centre_m, moved_m, kTip_m, is_beyond_the_law);
    }
  }
};

TEST(Proxy, OutsideItIsTheNearestPoint) {
  Walk walk;
  walk.to({15_mm, 0.0, 20_mm});
  EXPECT_NEAR(norm(walk.proxy.site().point_m - 20_mm * normalized(walk.centre_m)), 0.0, 1_mm);
  EXPECT_FALSE(walk.proxy.stays());
}

TEST(Proxy, PushedThroughTheMiddleItStaysOnTheSideWhereItWentIn) {
  Walk walk;
  walk.to({0.3_mm, 0.2_mm, -15_mm});  // 5 mm from the other side: the nearest point is there
  EXPECT_GT(walk.proxy.site().point_m.z, 10_mm);
  EXPECT_GT(walk.proxy.site().normal.z, 0.5);
  EXPECT_NEAR(walk.proxy.site().distance_m, -35_mm, 1_mm);
}

TEST(Proxy, OfALawBeyondItsRangeStaysWhereItIs) {
  Walk walk;
  walk.to({0.0, 0.0, 10_mm});
  const Vec3 before_m = walk.proxy.site().point_m;
  walk.to({5_mm, 0.0, 10_mm}, true);
  EXPECT_TRUE(walk.proxy.stays());
  EXPECT_EQ(walk.proxy.site().point_m, before_m);
}

TEST(Proxy, SlidesNoFartherThanItsShareOfTheToolsWay) {
  Walk walk;
  walk.to({0.0, 0.0, 4_mm});  // the nearest point moves 5 times as far as the tool
  const Vec3 before_m = walk.proxy.site().point_m;
  walk.to({2_mm, 0.0, 4_mm});
  EXPECT_LE(norm(walk.proxy.site().point_m - before_m), kTip_m + kSlide_ratio * 2_mm);
}

TEST(Proxy, OutOfThePlaceWhereItWentInItStartsAnew) {
  Walk walk;
  walk.to({0.0, 0.0, -15_mm});
  walk.to({0.0, 0.0, 25_mm});
  EXPECT_NEAR(walk.proxy.site().distance_m, 5_mm, 0.5_mm);
  EXPECT_FALSE(walk.proxy.stays());
}

TEST(Proxy, LeavesTheHeapAlone) {
  Walk walk;
  const tests::NoAlloc guard;
  walk.to({3_mm, 0.0, -10_mm});
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::model::contact::proxy_test
