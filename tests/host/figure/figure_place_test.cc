// SPDX-License-Identifier: Apache-2.0
// The place of the figure: by the tracked shoulder, else by the scene's, else before the device.
#include <gtest/gtest.h>

#include "host/figure/figure.h"
#include "tests/support/operator_motion.h"

namespace tact::host::figure::figure_place_test {

using Eigen::Vector3d;
using test::bodies_at;
using test::tool_at;

const Vector3d kShoulder_m(0.6, 0.1, 0.5);

Vector3d shoulder_after_s(Figure& figure, double until_s,
                          TrackedOperator (*bodies)(double) = nullptr) {
  for (double t_s = 0.0; t_s < until_s; t_s += test::kMotionFrame_s)
    figure.update(t_s, tool_at(t_s), bodies != nullptr ? bodies(t_s) : TrackedOperator{});
  return figure.pose()[FigureJoint::kRightShoulder];
}

TEST(FigurePlace, TheScenesShoulderIsTheFiguresWhileNoneIsTracked) {
  Figure anywhere, there({.shoulder_m = kShoulder_m});
  EXPECT_LT((shoulder_after_s(there, 0.1) - kShoulder_m).norm(), 0.01);
  EXPECT_GT((shoulder_after_s(anywhere, 0.1) - kShoulder_m).norm(), 0.03);
}

TEST(FigurePlace, ATrackedShoulderGoesBeforeTheScenes) {
  Figure by_tracker, by_both({.shoulder_m = kShoulder_m});
  const auto bodies = [](double t_s) { return bodies_at(t_s); };
  const Vector3d tracked_m = shoulder_after_s(by_tracker, 8.0, +bodies);
  EXPECT_LT((shoulder_after_s(by_both, 8.0, +bodies) - tracked_m).norm(), 0.02);
}

TEST(FigurePlace, TooDistantTrackedShoulderIsReportedAndIgnored) {
  Figure untracked, near, far;
  const Vector3d home_m = shoulder_after_s(untracked, 0.1);
  const auto place = [&](Figure& figure, double off_m) -> Vector3d {
    TrackedOperator bodies;
    bodies[BodyRole::kShoulder].state = BodyState::kTracked;
    bodies[BodyRole::kShoulder].pose.position_m = home_m + off_m * Vector3d::UnitX();
    for (int i = 0; i < 600; ++i) figure.update(i * test::kMotionFrame_s, tool_at(0.0), bodies);
    return figure.pose()[FigureJoint::kPelvis] - untracked.pose()[FigureJoint::kPelvis];
  };
  EXPECT_GT(place(near, kMaxPosition_m - 0.05).norm(), 0.4);
  EXPECT_EQ(near.pose().words.find("too far"), std::string::npos) << near.pose().words;
  EXPECT_LT(place(far, kMaxPosition_m + 0.05).norm(), 0.02);
  EXPECT_EQ(far.pose().words, "the tracked shoulder is too far off to be believed");
}

}  // namespace tact::host::figure::figure_place_test
