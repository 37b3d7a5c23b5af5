// SPDX-License-Identifier: Apache-2.0
// Every role of a tracking description, from its text and what a camera sees to the joint it moves.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "host/figure/figure.h"
#include "host/tracking/operator_tracker.h"
#include "tests/support/message.h"
#include "tests/support/operator_motion.h"
#include "tests/support/tracking_views.h"

namespace tact::host::figure::operator_roles_test {

using tests::message_of;

using Eigen::Vector3d;
using enum FigureJoint;

struct Case {
  const char* name;
  BodyRole role;
  Vector3d home_m;
  FigureJoint moves;
  std::vector<FigureJoint> stay;
};
void PrintTo(const Case& of, std::ostream* out) { *out << of.name; }

const std::vector<FigureJoint> kFeet{kLeftAnkle, kLeftToes, kRightAnkle, kRightToes};
const std::vector<FigureJoint> kLeft{kLeftHip, kLeftKnee, kLeftAnkle, kLeftToes};
const std::vector<FigureJoint> kRight{kRightHip, kRightKnee, kRightAnkle, kRightToes};
const std::vector<FigureJoint> kLeftArm{kLeftShoulder, kLeftElbow, kLeftWrist, kLeftFingers};
const std::vector<FigureJoint> kRightArm{kRightShoulder, kRightElbow, kRightWrist, kRightFingers};
const std::vector<FigureJoint> kBelow{kPelvis, kLeftKnee, kRightKnee, kLeftAnkle, kRightAnkle};

const std::vector<Case> kCases{
    {"head", BodyRole::kHead, {0.40, -0.08, 0.56}, kHead, kBelow},
    {"shoulder", BodyRole::kShoulder, {0.42, 0.12, 0.37}, kRightShoulder, kBelow},
    {"waist", BodyRole::kWaist, {0.42, -0.08, -0.13}, kPelvis, kFeet},
    {"wrist", BodyRole::kWrist, {0.10, 0.05, 0.10}, kRightKnuckles, kBelow},
    {"hand", BodyRole::kHand, {0.10, 0.05, 0.10}, kRightKnuckles, kBelow},
    {"left_leg", BodyRole::kLeftLeg, {0.35, -0.20, -0.55}, kLeftKnee, kRight},
    {"right_leg", BodyRole::kRightLeg, {0.35, 0.05, -0.55}, kRightKnee, kLeft},
    {"left_ankle", BodyRole::kLeftAnkle, {0.42, -0.20, -0.98}, kLeftAnkle, kRight},
    {"right_ankle", BodyRole::kRightAnkle, {0.42, 0.05, -0.98}, kRightAnkle, kLeft},
    {"left_hand", BodyRole::kLeftHand, {0.10, -0.30, 0.05}, kLeftWrist, kRightArm},
    {"elbow", BodyRole::kElbow, {0.42, 0.28, 0.06}, kRightElbow, kLeftArm}};

/// The camera is behind the device and looks at the operator.
const std::string kRegistration =
    "[registration]\nposition_m = [-1.6, 0, -0.2]\n"
    "rotation_wxyz = [0.70710678118654752, 0, 0.70710678118654752, 0]\n";

class Description : public testing::Test {
 protected:
  Description() : folder_("/tmp/tact-role-" + std::to_string(getpid())) {
    std::filesystem::create_directory(folder_);
  }
  ~Description() override { std::filesystem::remove_all(folder_); }

  /// The figure after four seconds, of which the body is away for the last two.
  FigurePose after(const std::string& role, const Vector3d& home_m, const Pose& away) {
    const std::string path = folder_ + "/desk.tracking.toml";
    test::write_file(path, test::description("udp_port = 1", {{"b", role}}, kRegistration));
    const model::Result<tracking::TrackingSetup> setup = tracking::load_tracking_setup(path);
    EXPECT_EQ(message_of(setup), "");
    if (!setup) return {};
    tracking::OperatorTracker tracker(*setup);
    Figure figure;
    std::mt19937 noise(5);
    for (std::uint64_t i = 0; i < 240; ++i) {
      const double now_s = static_cast<double>(i) / 60.0;
      Pose body{.position_m = home_m};
      if (i >= 120) body = {.rotation = away.rotation, .position_m = home_m + away.position_m};
      const tracking::Observation seen =
          test::look(setup->cameras[0], setup->registration, "b", body, now_s, i, &noise,
                     0.01);  // else it would be frozen
      EXPECT_EQ(message_of(tracker.take(seen, now_s)), "");
      last_ = tracker.at(now_s);
      figure.update(now_s, test::tool_at(0.0), last_);
    }
    return figure.pose();
  }

  std::string folder_;
  TrackedOperator last_;
};
class Role : public Description, public testing::WithParamInterface<Case> {};

const Pose kAway{.rotation = test::turn(0.3, {1.0, 0.2, 0.1}), .position_m = {-0.04, 0.06, 0.05}};

TEST_P(Role, RoleMovesItsOwnJointOnly) {
  const Case& of = GetParam();
  const FigurePose stays = after(of.name, of.home_m, Pose{});
  Pose away = kAway;
  if (of.role == BodyRole::kWaist) away.position_m.z() = -0.08;  // so that the legs reach the floor
  const FigurePose moved = after(of.name, of.home_m, away);
  for (std::size_t i = 0; i < kBodyRoles; ++i) {
    const bool its_own = static_cast<BodyRole>(i) == of.role;
    EXPECT_EQ(last_.bodies[i].state, its_own ? BodyState::kTracked : BodyState::kAbsent) << i;
  }
  EXPECT_GT((moved[of.moves] - stays[of.moves]).norm(), 0.01);
  for (const FigureJoint joint : of.stay) {
    EXPECT_LT((moved[joint] - stays[joint]).norm(), 1e-6)
        << kFigureJointNames[static_cast<std::size_t>(joint)];
  }
  EXPECT_LT((moved[kRightFingers] - moved.grip_m).norm(), kGripTolerance_m);
}

INSTANTIATE_TEST_SUITE_P(EveryName, Role, testing::ValuesIn(kCases),
                         [](const auto& it) { return std::string(it.param.name); });

TEST_F(Description, TrackedToolBodyMovesNoJoint) {
  const FigurePose stays = after("tool", {0.1, 0.0, 0.1}, Pose{});
  const FigurePose moved = after("tool", {0.1, 0.0, 0.1}, kAway);
  EXPECT_EQ(last_[BodyRole::kTool].state, BodyState::kTracked);
  for (std::size_t i = 0; i < kFigureJoints; ++i) EXPECT_EQ(moved.joint_m[i], stays.joint_m[i]);
}

TEST(Roles, AreAllTried) { EXPECT_EQ(kCases.size() + 1, kBodyRoles); }  // the tool is the one

}  // namespace tact::host::figure::operator_roles_test
