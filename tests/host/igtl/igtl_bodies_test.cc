// SPDX-License-Identifier: Apache-2.0
#include "host/igtl/igtl_bodies.h"

#include <gtest/gtest.h>

namespace tact::host::igtl::igtl_bodies_test {

using tracking::BodyRole;
using tracking::BodyState;
using tracking::TrackingTrouble;

pose::Pose at_x(double x_m) { return {.position_m = {x_m, 0.2, 0.3}}; }

TEST(IgtlBodies, ANameIsThatOfARoleAloneOrAsPlusWritesIt) {
  for (const char* name : {"left_leg", "LeftLeg", "LeftLegToDevice", "LeftLegToTrackerTransform"})
    EXPECT_EQ(role_of(name), BodyRole::kLeftLeg) << name;
  EXPECT_EQ(role_of("ToolToDevice"), BodyRole::kTool);
  EXPECT_EQ(role_of("HEAD"), BodyRole::kHead);
  EXPECT_EQ(role_of("LeftHandToDevice"), BodyRole::kLeftHand);
  EXPECT_EQ(role_of("Elbow"), BodyRole::kElbow);
  for (const char* name : {"", "To", "ToHead", "Probe", "ProbeToHead", "headtodevice", "Headed"})
    EXPECT_FALSE(role_of(name)) << name;
}

TEST(IgtlBodies, AreAbsentUntilTheyCameAndLostWhenTheyAreSilent) {
  IgtlBodies bodies;
  EXPECT_EQ(bodies.at(1.0)[BodyRole::kHead].state, BodyState::kAbsent);
  bodies.take(BodyRole::kHead, at_x(0.1), 100.0, 1.0);
  EXPECT_EQ(bodies.at(1.0)[BodyRole::kHead].state, BodyState::kTracked);
  EXPECT_EQ(bodies.at(1.0)[BodyRole::kHead].raw.position_m, at_x(0.1).position_m);
  EXPECT_EQ(bodies.at(1.0)[BodyRole::kWaist].state, BodyState::kAbsent);
  EXPECT_EQ(bodies.at(1.3)[BodyRole::kHead].state, BodyState::kHeld);
  EXPECT_EQ(bodies.at(2.0)[BodyRole::kHead].state, BodyState::kLost);
}

TEST(IgtlBodies, AJumpAFrozenPoseAndALateOneAreRejected) {
  IgtlBodies bodies;
  const auto head = [&](double now_s) { return bodies.at(now_s)[BodyRole::kHead]; };
  bodies.take(BodyRole::kHead, at_x(0.1), 100.0, 1.0);
  bodies.take(BodyRole::kHead, at_x(2.0), 100.02, 1.02);
  EXPECT_EQ(head(1.02).trouble, TrackingTrouble::kJump);
  EXPECT_EQ(head(1.02).raw.position_m.x(), 0.1);
  bodies.take(BodyRole::kHead, at_x(0.1), 99.9, 1.03);
  EXPECT_EQ(head(1.03).trouble, TrackingTrouble::kOutOfOrder);
  for (int i = 0; i < 40; ++i)
    bodies.take(BodyRole::kHead, at_x(0.11), 100.04 + 0.02 * i, 1.04 + 0.02 * i);
  EXPECT_EQ(head(1.84).trouble, TrackingTrouble::kFrozen);
}

TEST(IgtlBodies, ASenderWithoutAClockIsBelievedByTheTimeOfArrival) {
  for (const double sent_s : {0.0, 1.8e9}) {  // none, or always the same
    IgtlBodies bodies;
    for (int i = 0; i < 50; ++i)
      bodies.take(BodyRole::kHead, at_x(0.001 * i), sent_s, 1.0 + 0.02 * i);
    const tracking::TrackedBody head = bodies.at(2.0)[BodyRole::kHead];
    EXPECT_EQ(head.state, BodyState::kTracked);
    EXPECT_EQ(head.trouble, TrackingTrouble::kNone);
    EXPECT_EQ(head.raw.position_m.x(), 0.001 * 49);
  }
}

TEST(IgtlBodies, TheSameMessageAgainIsNoSignOfLife) {
  IgtlBodies bodies;
  for (int i = 0; i < 50; ++i) bodies.take(BodyRole::kHead, at_x(0.1), 100.0, 1.0 + 0.02 * i);
  EXPECT_EQ(bodies.at(2.0)[BodyRole::kHead].state, BodyState::kLost);
}

TEST(IgtlBodies, TheDescriptionsBodyGoesBeforeThatOfTheNetwork) {
  tracking::TrackedOperator first, second;
  first[BodyRole::kHead].state = BodyState::kLost;
  second[BodyRole::kHead].state = second[BodyRole::kWaist].state = BodyState::kTracked;
  const tracking::TrackedOperator both = joined(first, second);
  EXPECT_EQ(both[BodyRole::kHead].state, BodyState::kLost);
  EXPECT_EQ(both[BodyRole::kWaist].state, BodyState::kTracked);
  EXPECT_EQ(both[BodyRole::kHand].state, BodyState::kAbsent);
}

}  // namespace tact::host::igtl::igtl_bodies_test
