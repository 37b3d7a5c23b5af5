// Where the figure stands: by the tracked shoulder, else by the scene's, else before the device.
#include <gtest/gtest.h>

#include "host/tracking/figure.h"
#include "tests/operator_motion.h"

namespace tact::host {
namespace {

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

}  // namespace
}  // namespace tact::host
