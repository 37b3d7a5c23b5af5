// SPDX-License-Identifier: Apache-2.0
#include "host/tracking/body_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tact::host::tracking::body_tracker_test {

constexpr double kPeriod_s = 1.0 / 60.0;

/// One body seen by one or two cameras; both clocks run alike unless a test says otherwise.
class Body : public ::testing::Test {
 protected:
  /// An observation with its own points and a pose at x; true if the pose was wanted.
  bool see(double x_m, std::size_t camera = 0) {
    return see(Pose{.position_m = {x_m, 0, 1}}, camera);
  }
  bool see(const Pose& pose, std::size_t camera = 0) {
    Observation seen{
        .time_s = time_s, .sequence = sequence, .camera = "c", .body = "b", .points = {}};
    seen.points.push_back({.id = 0, .pixel_px = {moving ? 1e-3 * ++count : 0.0, 0.0}});
    const bool wanted = tracker.admit(camera, sample_of(seen), now_s);
    if (wanted) tracker.take({.status = status, .pose = pose, .rms_px = 0.4}, time_s, now_s);
    return wanted;
  }
  void step(double period_s = kPeriod_s) {
    time_s += period_s;
    now_s += period_s;
    ++sequence;
  }
  TrackedBody now() const { return tracker.at(now_s); }

  BodyTracker tracker{2};
  double time_s = 100.0, now_s = 5.0;
  std::uint64_t sequence = 7;
  pose::PoseStatus status = pose::PoseStatus::kOk;
  bool moving = true;  // the points differ from one observation to the next
  int count = 0;
};

TEST_F(Body, NeverSeenIsLostAndSilent) {
  EXPECT_EQ(now().state, BodyState::kLost);
  EXPECT_EQ(now().trouble, TrackingTrouble::kSilent);
  EXPECT_TRUE(std::isfinite(now().age_s));
  EXPECT_FALSE(tracker.last_pose());
}

TEST_F(Body, IsTrackedThenHeldThenLost) {
  see(0.2);
  EXPECT_EQ(now().state, BodyState::kTracked);
  EXPECT_EQ(now().trouble, TrackingTrouble::kNone);
  EXPECT_EQ(now().raw.position_m.x(), 0.2);
  EXPECT_EQ(now().rms_px, 0.4);
  const auto state = [&](double age_s) { return tracker.at(now_s + age_s).state; };
  EXPECT_EQ(state(kHold_s), BodyState::kTracked);
  EXPECT_EQ(state(kHold_s + 1e-9), BodyState::kHeld);
  EXPECT_EQ(state(kLose_s), BodyState::kHeld);
  EXPECT_EQ(state(kLose_s + 1e-9), BodyState::kLost);
  EXPECT_EQ(tracker.at(now_s + 0.2).trouble, TrackingTrouble::kSilent);
  EXPECT_NEAR(tracker.at(now_s + 0.2).age_s, 0.2, 1e-12);
  EXPECT_EQ(tracker.at(now_s + 0.2).raw.position_m.x(), 0.2);  // the last one is kept
}

TEST_F(Body, APoseThatCannotBeHadSaysWhy) {
  see(0.0);
  const std::pair<pose::PoseStatus, TrackingTrouble> cases[] = {
      {pose::PoseStatus::kTooFewPoints, TrackingTrouble::kTooFewPoints},
      {pose::PoseStatus::kDegenerate, TrackingTrouble::kDegenerate},
      {pose::PoseStatus::kInvalid, TrackingTrouble::kInvalid},
      {pose::PoseStatus::kNoPose, TrackingTrouble::kNoPose}};
  for (const auto& [wrong, trouble] : cases) {
    step();
    status = wrong;
    see(9.0);
    EXPECT_EQ(now().trouble, trouble);
    EXPECT_EQ(now().raw.position_m.x(), 0.0);
  }
  step();
  status = pose::PoseStatus::kOk;
  see(0.01);
  EXPECT_EQ(now().trouble, TrackingTrouble::kNone);
}

TEST_F(Body, AJumpIsHeldAndBelievedWithTheThirdPoseThatAgrees) {
  for (int i = 0; i < 10; ++i, step()) see(0.0);
  for (int i = 0; i < 2; ++i, step()) {
    see(1.0 + 0.01 * i);  // 60 m/s
    EXPECT_EQ(now().trouble, TrackingTrouble::kJump);
    EXPECT_EQ(now().raw.position_m.x(), 0.0);
  }
  see(1.02);
  EXPECT_EQ(now().trouble, TrackingTrouble::kNone);
  EXPECT_EQ(now().raw.position_m.x(), 1.02);
  EXPECT_EQ(now().pose.position_m.x(), 1.02);  // the filter does not drag it over
}

TEST_F(Body, PosesThatJumpAboutAreNeverBelieved) {
  for (int i = 0; i < 10; ++i, step()) see(0.0);
  for (int i = 0; i < 60; ++i, step()) {
    see(i % 2 == 0 ? 1.0 : -1.0);
    EXPECT_EQ(now().trouble, TrackingTrouble::kJump);
    const double since_s = (i + 1) * kPeriod_s;  // the last good pose
    if (since_s > kHold_s + 1e-6 && since_s < kLose_s - 1e-6)
      EXPECT_EQ(now().state, BodyState::kHeld) << i;
  }
  EXPECT_EQ(now().raw.position_m.x(), 0.0);
  EXPECT_EQ(now().state, BodyState::kLost);
  EXPECT_EQ(now().trouble, TrackingTrouble::kJump) << "and still says why";
}

TEST_F(Body, OneWildPoseDoesNotDisturbTheFilter) {
  BodyTracker calm{2};
  std::swap(calm, tracker);
  for (int i = 0; i < 30; ++i, step()) see(i % 2 == 0 ? 0.0 : 0.004);
  const double before_m = now().pose.position_m.x();
  see(1.0);
  step();
  see(0.004);
  EXPECT_LT(std::abs(now().pose.position_m.x() - before_m), 0.002);
}

TEST_F(Body, AMirroredPoseIsAJumpThoughItIsAtRest) {
  for (int i = 0; i < 10; ++i, step()) see(0.0);
  see(Pose{.rotation = Eigen::Quaterniond(0, 1, 0, 0), .position_m = {0, 0, 1}});
  EXPECT_EQ(now().trouble, TrackingTrouble::kJump);
}

TEST_F(Body, AHandAtFourMetresASecondIsNoJump) {
  for (int i = 0; i < 20; ++i, step()) {
    see(4.0 * i * kPeriod_s);
    EXPECT_EQ(now().trouble, TrackingTrouble::kNone) << i;
  }
}

TEST_F(Body, TheSameNumbersForHalfASecondAreFrozen) {
  moving = false;
  int wanted = 0;
  for (int i = 0; i < 60; ++i, step()) wanted += see(0.0) ? 1 : 0;
  EXPECT_EQ(now().trouble, TrackingTrouble::kFrozen);
  EXPECT_NEAR(wanted, kFrozen_s / kPeriod_s, 1.5);
  for (int i = 0; i < 60; ++i, step()) see(0.0);
  EXPECT_EQ(now().state, BodyState::kLost);
  moving = true;
  EXPECT_TRUE(see(0.0));
  EXPECT_EQ(now().state, BodyState::kTracked);
}

TEST_F(Body, AnOlderOrRepeatedObservationIsNotTaken) {
  see(0.0);
  EXPECT_FALSE(see(0.3));  // a datagram twice
  EXPECT_EQ(now().trouble, TrackingTrouble::kOutOfOrder);
  step();
  see(0.01);
  time_s -= 0.5 * kPeriod_s;
  ++sequence;
  EXPECT_FALSE(see(0.3));
  time_s += kPeriod_s;
  sequence -= 2;
  EXPECT_FALSE(see(0.3));
  EXPECT_EQ(now().raw.position_m.x(), 0.01);
  EXPECT_EQ(now().trouble, TrackingTrouble::kOutOfOrder);
}

TEST_F(Body, ARecordingThatStartsAgainIsANewBeginning) {
  for (int i = 0; i < 60; ++i, step()) see(0.0);
  time_s = 0.0;
  sequence = 0;
  EXPECT_TRUE(see(1.0));  // and elsewhere: no jump
  EXPECT_EQ(now().trouble, TrackingTrouble::kNone);
  EXPECT_EQ(now().raw.position_m.x(), 1.0);
  EXPECT_EQ(now().pose.position_m.x(), 1.0);
}

TEST_F(Body, SequenceFromZeroAfterAPauseIsARestartOfTheSender) {
  for (int i = 0; i < 60; ++i, step()) see(0.0);
  time_s += 2.0;
  now_s += 2.0;
  sequence = 0;
  EXPECT_TRUE(see(0.0));
  step();
  EXPECT_TRUE(see(0.0));
}

TEST_F(Body, NewerPoseOfTwoCamerasIsUsed) {
  see(0.0, 0);
  time_s += 0.004;
  EXPECT_TRUE(see(0.002, 1));
  EXPECT_EQ(now().raw.position_m.x(), 0.002);
  time_s -= 0.002;
  ++sequence;
  see(0.1, 0);  // in order for its camera, but older than the other's
  EXPECT_EQ(now().trouble, TrackingTrouble::kNone);
  EXPECT_EQ(now().raw.position_m.x(), 0.002);
}

TEST_F(Body, LateLookOfTheOtherCameraIsTakenWithinTheJoinTime) {
  see(0.0, 0);
  step(0.1);
  const double good_s = time_s;
  see(0.001, 1);
  time_s = good_s - 0.9 * kTogether_s;
  EXPECT_TRUE(see(0.1, 0));
  time_s = good_s;
  ++sequence;
  EXPECT_TRUE(see(0.1, 0));  // of the same moment exactly
  EXPECT_EQ(now().raw.position_m.x(), 0.001);

  step(0.1);
  see(0.002, 1);
  time_s -= 1.1 * kTogether_s;
  ++sequence;
  EXPECT_FALSE(see(0.1, 0));
}

TEST_F(Body, ARefinedPoseReplacesTheGoodOneOfItsTimeAndNoOther) {
  for (int i = 0; i < 30; ++i, step()) see(0.0);
  BodyTracker twin = tracker;
  const pose::PoseEstimate better{.status = pose::PoseStatus::kOk,
                                  .pose = {.position_m = {0.004, 0, 1}}};
  twin.take(better, time_s, now_s);
  see(0.010);
  const TrackedBody before = now();
  EXPECT_FALSE(tracker.refine(better, time_s - 1e-3));
  EXPECT_FALSE(tracker.refine(better, time_s + 1e-3));
  EXPECT_FALSE(tracker.refine({.status = pose::PoseStatus::kNoPose, .pose = better.pose}, time_s));
  EXPECT_EQ(now().raw.position_m.x(), 0.010);
  EXPECT_TRUE(tracker.refine(better, time_s));
  EXPECT_EQ(now().raw.position_m.x(), 0.004);
  // The filter has forgotten the pose that was replaced.
  EXPECT_EQ(now().pose.position_m.x(), twin.at(now_s).pose.position_m.x());
  EXPECT_LT(now().pose.position_m.x(), 0.003);
  EXPECT_EQ(now().age_s, before.age_s);
}

TEST_F(Body, KnowsACameraThatRepeatsItself) {
  see(0.0);
  EXPECT_FALSE(tracker.repeats(0));
  moving = false;
  step();
  see(0.0);
  EXPECT_FALSE(tracker.repeats(0));
  step();
  see(0.0);
  EXPECT_TRUE(tracker.repeats(0));
}

}  // namespace tact::host::tracking::body_tracker_test
