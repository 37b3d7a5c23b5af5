// SPDX-License-Identifier: Apache-2.0
// Two cameras, one body: when the operator's tracker solves their looks together, and when not.
#include <gtest/gtest.h>

#include <algorithm>

#include "host/tracking/operator_tracker.h"
#include "tests/support/tracking_views.h"

namespace tact::host::tracking::joint_tracking_test {

using Eigen::Vector3d;

const Vector3d kPlace_m{0.2, -0.1, 0.4};
const Pose kFront = test::eye_towards(kPlace_m, Vector3d(0.1, 0.2, 1.0).normalized(), 2.0);
const Pose kSide = test::eye_towards(kPlace_m, Vector3d(-1.0, 0.1, 0.2).normalized(), 2.0, 0.4);
const Pose kTable{.rotation = test::turn(1.9, {1.0, 1.0, 0.3}), .position_m = {-0.8, 0.6, -0.9}};
constexpr double kPeriod_s = 1.0 / 30.0;

double off_m(const Pose& got, const Pose& truth) {
  return (got.position_m - truth.position_m).norm();
}

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values.at(static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

/// A hand that two cameras look at, 30 times a second each, the second `gap_s` after the first.
class TwoCameras : public ::testing::Test {
 protected:
  TrackingSetup setup() const {
    TrackingSetup out = test::setup_of({front, side}, {{"h", BodyRole::kHand}});
    out.registration = kTable;
    return out;
  }
  Observation see(const TrackingCamera& camera, double at_s) {
    return test::look(camera, camera.name == "front" ? kFront : kSide, "h", body, at_s, ++count,
                      &noise, noise_px);
  }
  /// One period; how far off the raw pose is after each camera's look.
  void step() {
    time_s += kPeriod_s;
    tracker.take(see(front, time_s), time_s);
    first_m.push_back(raw_off_m());
    tracker.take(see(side, time_s + gap_s), time_s + gap_s);
    both_m.push_back(raw_off_m());
  }
  TrackedBody hand() const { return tracker.at(time_s + gap_s)[BodyRole::kHand]; }
  double raw_off_m() const { return off_m(hand().raw, pose::drive(kTable, body)); }
  double median_mm() const { return 1e3 * quantile(both_m, 0.5); }

  TrackingCamera front = test::camera("front", kFront), side = test::camera("side", kSide);
  OperatorTracker tracker{setup()};
  Pose body{.rotation = test::turn(0.4, {3, 1, 2}), .position_m = kPlace_m};
  double time_s = 10.0, gap_s = 0.004, noise_px = 0.5;
  std::uint64_t count = 0;
  std::mt19937 noise{3};
  std::vector<double> first_m, both_m;
};

TEST_F(TwoCameras, TogetherStayWithinThreeMillimetresAtTwoMetres) {
  for (int i = 0; i < 500; ++i) step();
  EXPECT_LT(quantile(both_m, 0.5), 0.0015);
  EXPECT_LT(quantile(both_m, 0.95), 0.003);
  EXPECT_GT(quantile(first_m, 0.5), 0.003);  // the look that is alone
  EXPECT_EQ(hand().trouble, TrackingTrouble::kNone);
  EXPECT_LT(hand().rms_px, 1.2);
  EXPECT_GT(hand().rms_px, 0.2);
}

TEST_F(TwoCameras, AreExactWithoutNoise) {
  noise_px = 0.0;
  for (int i = 0; i < 3; ++i) {
    body.position_m.x() += 0.001 * i;
    step();
    EXPECT_LT(both_m.back(), 1e-8);
  }
}

TEST_F(TwoCameras, SimultaneousLooksGiveOnePoseAndOneFilterStep) {
  gap_s = 0.0;
  OperatorTracker late(setup());
  for (int i = 0; i < 200; ++i) {
    step();
    Observation a = see(front, time_s), b = see(side, time_s - 0.002);
    late.take(a, time_s);  // and of a camera whose looks arrive after newer ones of the other
    late.take(b, time_s);
    const TrackedBody seen = late.at(time_s)[BodyRole::kHand];
    first_m.back() = off_m(seen.raw, pose::drive(kTable, body));
    if (i > 100) {
      EXPECT_LT(off_m(hand().pose, pose::drive(kTable, body)), 0.0025) << i;
      EXPECT_LT(off_m(seen.pose, pose::drive(kTable, body)), 0.0025) << i;
    }
  }
  EXPECT_LT(quantile(both_m, 0.95), 0.003);
  EXPECT_LT(quantile(first_m, 0.95), 0.003);
}

TEST_F(TwoCameras, MoreThanTwentyMillisecondsApartAreNotJoined) {
  gap_s = 0.019;
  for (int i = 0; i < 200; ++i) step();
  const double near_mm = median_mm();
  both_m.clear();
  gap_s = 0.021;
  time_s = 100.0;
  for (int i = 0; i < 200; ++i, time_s += kPeriod_s) step();  // 45 ms to the look after
  EXPECT_LT(near_mm, 1.5);
  EXPECT_GT(median_mm(), 3.0);
}

TEST_F(TwoCameras, CoveredCameraLeavesThePoseOfTheOther) {
  for (int i = 0; i < 20; ++i) step();
  both_m.clear();
  for (int i = 0; i < 200; ++i) {
    time_s += kPeriod_s;
    tracker.take(see(front, time_s), time_s);
    Observation covered = see(side, time_s + gap_s);
    covered.points.resize(3);
    if (i % 2 == 0) tracker.take(covered, time_s + gap_s);
    EXPECT_EQ(hand().trouble, i % 2 == 0 ? TrackingTrouble::kTooFewPoints : TrackingTrouble::kNone);
    EXPECT_EQ(hand().state, BodyState::kTracked);
    both_m.push_back(raw_off_m());
  }
  EXPECT_GT(median_mm(), 3.0);   // of one camera
  EXPECT_LT(median_mm(), 15.0);  // but of one that is good
}

TEST_F(TwoCameras, ContradictoryCamerasAreUsedSeparately) {
  // The side camera is 3 cm from its place: within what a jump may be.
  gap_s = 0.010;
  side.pose->position_m += 0.03 * Vector3d::UnitY();
  tracker = OperatorTracker(setup());
  for (int i = 0; i < 200; ++i) {
    step();
    EXPECT_EQ(hand().trouble, TrackingTrouble::kNone) << i;
    EXPECT_EQ(hand().state, BodyState::kTracked);
  }
  EXPECT_LT(quantile(first_m, 0.5), 0.015);  // not drawn over by the other
  EXPECT_NEAR(median_mm(), 30.0, 8.0);       // the newest counts, as if it were alone
}

TEST_F(TwoCameras, AWrongMarkerInOneViewBendsNothing) {
  for (int i = 0; i < 200; ++i) {
    time_s += kPeriod_s;
    tracker.take(see(front, time_s), time_s);
    Observation seen = see(side, time_s + gap_s);
    seen.points[static_cast<std::size_t>(i % 8)].pixel_px += Eigen::Vector2d(35.0, -25.0);
    tracker.take(seen, time_s + gap_s);
    both_m.push_back(raw_off_m());
  }
  EXPECT_LT(quantile(both_m, 0.95), 0.003);
}

TEST_F(TwoCameras, ACameraThatRepeatsItselfDoesNotDragTheOther) {
  step();
  const Observation still = see(side, time_s);
  for (int i = 0; i < 30; ++i) {
    body.position_m.x() += 0.0005;  // slow: the old picture is within the noise at first
    time_s += kPeriod_s;
    Observation again = still;
    again.time_s = time_s - gap_s;
    again.sequence = ++count;
    tracker.take(again, time_s - gap_s);
    const Observation now = see(front, time_s);
    tracker.take(now, time_s);
    // As if the front camera were alone.
    OperatorTracker alone(setup());
    alone.take(now, time_s);
    if (i > 0) EXPECT_LT(off_m(hand().raw, alone.at(time_s)[BodyRole::kHand].raw), 1e-9) << i;
  }
}

TEST_F(TwoCameras, ACameraThatJumpsDoesNotEnter) {
  for (int i = 0; i < 20; ++i) step();
  first_m.clear();
  for (int i = 0; i < 40; ++i) {
    time_s += kPeriod_s;
    // The side camera sees it here and there, each time elsewhere, just before the front one.
    const Pose truth = body;
    body.position_m += (i % 2 == 0 ? 0.3 : -0.3) * Vector3d::UnitY();
    tracker.take(see(side, time_s - gap_s), time_s - gap_s);
    body = truth;
    EXPECT_EQ(hand().trouble, TrackingTrouble::kJump) << i;
    tracker.take(see(front, time_s), time_s);
    EXPECT_EQ(hand().trouble, TrackingTrouble::kNone) << i;
    first_m.push_back(raw_off_m());
  }
  EXPECT_LT(quantile(first_m, 1.0), 0.05);
}

TEST_F(TwoCameras, ALookThatIsNotBelievedDoesNotEnterTheNext) {
  for (int i = 0; i < 20; ++i) step();
  body.position_m += 0.3 * Vector3d::UnitY();  // both see it there, 10 ms from look to look
  time_s += kPeriod_s;
  tracker.take(see(side, time_s), time_s);
  tracker.take(see(front, time_s + 0.010), time_s + 0.010);
  EXPECT_EQ(hand().trouble, TrackingTrouble::kJump);
  const Observation third = see(side, time_s + 0.020);
  tracker.take(third, time_s + 0.020);
  EXPECT_EQ(hand().trouble, TrackingTrouble::kNone);
  OperatorTracker alone(setup());
  alone.take(third, time_s);
  EXPECT_LT(off_m(hand().raw, alone.at(time_s)[BodyRole::kHand].raw), 1e-9);
}

TEST_F(TwoCameras, ACameraFoundFromTheBaseEntersWhenItsPlaceIsKnown) {
  side.pose.reset();
  TrackingSetup with_base =
      test::setup_of({front, side}, {{"h", BodyRole::kHand}, {"floor", std::nullopt}});
  with_base.registration = kTable;
  tracker = OperatorTracker(with_base);
  noise_px = 0.0;
  step();
  EXPECT_EQ(hand().trouble, TrackingTrouble::kNoPose);
  time_s += kPeriod_s;
  tracker.take(test::look(side, kSide, "floor", Pose{}, time_s, ++count), time_s);
  noise_px = 0.5;
  for (int i = 0; i < 200; ++i) step();
  EXPECT_LT(quantile({both_m.begin() + 1, both_m.end()}, 0.95), 0.003);
}

}  // namespace tact::host::tracking::joint_tracking_test
