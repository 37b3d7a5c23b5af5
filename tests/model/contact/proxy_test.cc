// SPDX-License-Identifier: Apache-2.0
#include "model/contact/proxy.h"

#include <gtest/gtest.h>

#include <algorithm>
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
  double most_turn_m = 0.0;  // of the line to the proxy, in a tick
  void to(const Vec3& goal_m) {
    while (norm(goal_m - centre_m) > 1e-12) {
      const double way_m = norm(goal_m - centre_m);
      const Vec3 moved_m = std::min(1.0, 0.1_mm / way_m) * (goal_m - centre_m);
      centre_m += moved_m;
      const Vec3 before_m = line_m();
      proxy.follow(ball.view(), centre_m, moved_m, kTip_m);
      most_turn_m = std::max(most_turn_m, norm(line_m() - before_m));
    }
  }
  /// From the centre to the proxy.
  Vec3 line_m() const {
    return (kTip_m - proxy.contact_point().distance_m) * proxy.contact_point().normal;
  }
};

TEST(Proxy, ProxyOutsideIsTheNearestPoint) {
  Walk walk;
  walk.to({15_mm, 0.0, 20_mm});
  EXPECT_NEAR(norm(walk.proxy.contact_point().point_m - 20_mm * normalized(walk.centre_m)), 0.0,
              1_mm);
  EXPECT_FALSE(walk.proxy.lags());
}

TEST(Proxy, PushedThroughTheMiddleItStaysOnTheSideWhereItWentIn) {
  Walk walk;
  walk.to({0.3_mm, 0.2_mm, -15_mm});  // 5 mm from the other side: the nearest point is there
  EXPECT_GT(walk.proxy.contact_point().point_m.z, 10_mm);
  EXPECT_GT(walk.proxy.contact_point().normal.z, 0.5);
  EXPECT_NEAR(walk.proxy.contact_point().distance_m, -35_mm, 1_mm);
}

TEST(Proxy, SlidesAtMostTwiceAsFarAsTheTool) {
  Walk walk;
  walk.to({0.0, 0.0, 2_mm});  // the nearest point moves 12 times as far as the tool
  walk.most_turn_m = 0.0;
  walk.to({2_mm, 0.0, 2_mm});
  EXPECT_TRUE(walk.proxy.lags());
  EXPECT_GT(walk.proxy.contact_point().point_m.x, 3_mm);
  EXPECT_LE(walk.most_turn_m, (1.0 + kSlide_ratio) * 0.1_mm + 1e-9);
}

TEST(Proxy, LeavesByTheSideWithoutAJump) {
  Walk walk;
  walk.to({0.0, 0.0, 2_mm});
  walk.to({40_mm, 0.0, 2_mm});
  EXPECT_FALSE(walk.proxy.lags());
  EXPECT_NEAR(walk.proxy.contact_point().distance_m, 20_mm, 1_mm);
  EXPECT_LE(walk.most_turn_m, (1.0 + kSlide_ratio) * 0.1_mm + 1e-9);
}

TEST(Proxy, ProxyAfterExitIsTheNearestPoint) {
  Walk walk;
  walk.to({0.0, 0.0, -15_mm});
  walk.to({0.0, 0.0, 25_mm});
  EXPECT_NEAR(walk.proxy.contact_point().distance_m, 5_mm, 0.5_mm);
  EXPECT_FALSE(walk.proxy.lags());
}

TEST(Proxy, LeavesTheHeapAlone) {
  Walk walk;
  const tests::NoAlloc guard;
  walk.to({3_mm, 0.0, -10_mm});
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::model::contact::proxy_test
