// SPDX-License-Identifier: Apache-2.0
#include "host/tracking/operator_tracker.h"

#include <gtest/gtest.h>

#include "tests/support/message.h"
#include "tests/support/tracking_views.h"

namespace tact::host::tracking::operator_tracker_test {

using tests::message_of;

using Eigen::Quaterniond;
using Eigen::Vector3d;

const Pose kEye{.rotation = test::turn(0.7, {0.2, 1.0, -0.3}), .position_m = {0.4, -0.2, -1.5}};
const Pose kOther{.rotation = test::turn(-0.6, {0.1, 1.0, 0.2}), .position_m = {-0.9, 0.1, -1.2}};
const Pose kTable{.rotation = test::turn(1.9, {1.0, 1.0, 0.3}), .position_m = {-0.8, 0.6, -0.9}};

/// In front of a camera.
Pose before(const Pose& eye, double x_m = 0.0) {
  return pose::drive(eye, {.rotation = test::turn(0.8, {1, 2, 3}), .position_m = {x_m, 0.05, 1.8}});
}

double distance(const Pose& a, const Pose& b) {
  return a.rotation.angularDistance(b.rotation) + (a.position_m - b.position_m).norm();
}

TEST(OperatorTracker, GivesTheBodyInTheDevicesFrame) {
  const TrackingCamera eye = test::camera("front", kEye);
  TrackingSetup setup = test::setup_of({eye}, {{"h", BodyRole::kHand}});
  setup.registration = kTable;
  OperatorTracker tracker(setup);
  const Pose body = before(kEye);
  ASSERT_EQ(message_of(tracker.take(test::look(eye, kEye, "h", body, 1.0, 1), 0.0)), "");
  // By matrices: p_W = D (E (inverse E (B p)))  =  D B p
  const auto matrix = [](const Pose& pose) {
    return Eigen::Isometry3d(Eigen::Translation3d(pose.position_m) * pose.rotation);
  };
  const Eigen::Isometry3d expected = matrix(kTable) * matrix(body);
  const TrackedOperator now = tracker.at(0.01);
  const TrackedBody& hand = now[BodyRole::kHand];
  EXPECT_EQ(hand.state, BodyState::kTracked);
  EXPECT_LT((hand.raw.position_m - expected.translation()).norm(), 1e-6);
  EXPECT_LT((hand.raw.rotation.toRotationMatrix() - expected.rotation()).norm(), 1e-6);
  EXPECT_EQ(now.time_s, 0.01);
  EXPECT_EQ(now[BodyRole::kHead].state, BodyState::kAbsent);
}

TEST(OperatorTracker, TwoCamerasAgreeAboutTheSameBody) {
  const TrackingCamera eye = test::camera("front", kEye), other = test::camera("side", kOther);
  OperatorTracker tracker(test::setup_of({eye, other}, {{"h", BodyRole::kHand}}));
  const Pose body{.rotation = test::turn(0.4, {3, 1, 2}), .position_m = {0.0, 0.0, 0.3}};
  tracker.take(test::look(eye, kEye, "h", body, 1.0, 1), 0.0);
  EXPECT_LT(distance(tracker.at(0.0)[BodyRole::kHand].raw, body), 1e-6);
  tracker.take(test::look(other, kOther, "h", body, 1.001, 1), 0.001);
  EXPECT_EQ(tracker.at(0.001)[BodyRole::kHand].age_s, 0.0);
  EXPECT_LT(distance(tracker.at(0.001)[BodyRole::kHand].raw, body), 1e-6);
}

TEST(OperatorTracker, ACameraWithoutAPlaceIsFoundFromTheBase) {
  const TrackingCamera eye = test::camera("front", std::nullopt);
  OperatorTracker tracker(test::setup_of({eye}, {{"floor", std::nullopt}, {"h", BodyRole::kHand}}));
  // The base's axes are the tracker's: its markers stand around the tracker's origin.
  const Pose far{.rotation = kEye.rotation, .position_m = kEye.rotation * Vector3d(0, 0, -2.0)};
  const Pose seen_from_far = before(far, 0.2);
  tracker.take(test::look(eye, far, "h", seen_from_far, 1.0, 1), 0.0);
  EXPECT_EQ(tracker.at(0.0)[BodyRole::kHand].trouble, TrackingTrouble::kNoPose);
  tracker.take(test::look(eye, far, "floor", Pose{}, 1.01, 2), 0.01);
  tracker.take(test::look(eye, far, "h", seen_from_far, 1.02, 3), 0.02);
  EXPECT_LT(distance(tracker.at(0.02)[BodyRole::kHand].raw, seen_from_far), 1e-5);
  // The base is hidden: the camera stays where it was.
  tracker.take(test::look(eye, far, "h", seen_from_far, 9.0, 99), 8.0);
  EXPECT_LT(distance(tracker.at(8.0)[BodyRole::kHand].raw, seen_from_far), 1e-5);
}

TEST(OperatorTracker, PoseFromSomeMarkersIgnoresUnknownMarkers) {
  const TrackingCamera eye = test::camera("front", kEye);
  OperatorTracker tracker(test::setup_of({eye}, {{"h", BodyRole::kHand}}));
  const Pose body = before(kEye);
  Observation seen = test::look(eye, kEye, "h", body, 1.0, 1);
  std::swap(seen.points[0], seen.points[5]);  // in any order
  seen.points.resize(6);
  seen.points.push_back({.id = 77, .pixel_px = {5.0, 5.0}});
  tracker.take(seen, 0.0);
  EXPECT_LT(distance(tracker.at(0.0)[BodyRole::kHand].raw, body), 1e-6);
  seen = test::look(eye, kEye, "h", body, 1.1, 2);
  seen.points.resize(3);
  tracker.take(seen, 0.1);
  EXPECT_EQ(tracker.at(0.1)[BodyRole::kHand].trouble, TrackingTrouble::kTooFewPoints);
}

TEST(OperatorTracker, ASweepTrackerSendsTangents) {
  TrackingCamera eye = test::camera("front", kEye);
  eye.lens = {.fx_px = 1.0, .fy_px = 1.0};
  eye.outlier_px = 0.0025;
  OperatorTracker tracker(test::setup_of({eye}, {{"h", BodyRole::kHand}}));
  tracker.take(test::look(eye, kEye, "h", before(kEye), 1.0, 1), 0.0);
  EXPECT_LT(distance(tracker.at(0.0)[BodyRole::kHand].raw, before(kEye)), 1e-6);
}

TEST(OperatorTracker, RepeatedOrOldPicturesAreHeldThenLost) {
  const TrackingCamera eye = test::camera("front", kEye);
  for (const double older_s : {0.0, 0.4}) {
    OperatorTracker tracker(test::setup_of({eye}, {{"h", BodyRole::kHand}}));
    const auto at = [&](double now_s) { return tracker.at(now_s)[BodyRole::kHand]; };
    ASSERT_EQ(message_of(tracker.take(test::look(eye, kEye, "h", before(kEye), 5.0, 300), 0.0)),
              "");
    ASSERT_EQ(at(0.0).state, BodyState::kTracked);
    bool was_held = false;
    double now_s = 0.0;
    for (std::uint64_t i = 1; i <= 60; ++i) {  // a second of one picture, or of older ones
      now_s = static_cast<double>(i) / 60.0;
      const double seen_s = older_s > 0.0 ? 5.0 - older_s + 1e-3 * static_cast<double>(i) : 5.0;
      const std::uint64_t sequence = older_s > 0.0 ? 200 + i : 300;
      tracker.take(test::look(eye, kEye, "h", before(kEye), seen_s, sequence), now_s);
      EXPECT_EQ(at(now_s).trouble, TrackingTrouble::kOutOfOrder) << i;
      was_held = was_held || at(now_s).state == BodyState::kHeld;
    }
    EXPECT_TRUE(was_held);
    EXPECT_EQ(at(now_s).state, BodyState::kLost);
    EXPECT_NEAR(at(now_s).age_s, 1.0, 1e-9);
    tracker.take(test::look(eye, kEye, "h", before(kEye, 0.01), 5.5, 400), 1.01);
    EXPECT_EQ(at(1.01).state, BodyState::kTracked) << "what goes on is believed again";
  }
}

TEST(OperatorTracker, SaysWhichNameItDoesNotKnow) {
  const TrackingCamera eye = test::camera("front", kEye);
  OperatorTracker tracker(test::setup_of({eye}, {{"h", BodyRole::kHand}}));
  Observation seen = test::look(eye, kEye, "h", before(kEye), 1.0, 1);
  seen.camera = "back";
  EXPECT_NE(message_of(tracker.take(seen, 0.0)).find("camera back is not in made-up"),
            std::string::npos);
  seen.camera = "front";
  seen.body = "foot";
  EXPECT_NE(message_of(tracker.take(seen, 0.0)).find("body foot is not in made-up"),
            std::string::npos);
  EXPECT_EQ(tracker.at(0.0)[BodyRole::kHand].state, BodyState::kLost);
}

}  // namespace tact::host::tracking::operator_tracker_test
