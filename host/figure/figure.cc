// SPDX-License-Identifier: Apache-2.0
#include "host/figure/figure.h"

#include <algorithm>
#include <cmath>

#include "host/figure/figure_text.h"
#include "host/figure/limb.h"

namespace tact::host::figure {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kLongestStep_s = 0.1;  // limits a fade's progress after a pause
constexpr double kWaitForShoulder_s = 1.0;

constexpr double kElbowHint = 0.35;  // chosen by eye: the left elbow points down and outward

/// The rotation, limited to an angle of `most_rad`.
Quaterniond at_most(const Quaterniond& q, double most_rad) {
  const double angle_rad = q.angularDistance(Quaterniond::Identity());
  return angle_rad > most_rad ? Quaterniond::Identity().slerp(most_rad / angle_rad, q) : q;
}

Quaterniond part_of(const Quaterniond& q, double share) {
  return Quaterniond::Identity().slerp(share, q);
}

Pose placed(const Pose& pose, const Vector3d& by_m) {
  return {.rotation = pose.rotation, .position_m = pose.position_m + by_m};
}

/// The shift from the default place that moves the right shoulder to `shoulder_m`.
Vector3d to_shoulder(const BodyPlan& plan, const Vector3d& shoulder_m) {
  return shoulder_m - standing_pelvis(plan).position_m -
         upright_m(plan, FigureJoint::kRightShoulder);
}

}  // namespace

Figure::Figure(const FigureSettings& settings)
    : settings_(settings),
      plan_(make_body_plan(settings.height_m)),
      arm_(plan_, settings.root_rule),
      pelvis_(standing_pelvis(plan_)) {
  if (settings.shoulder_m) place_m_ = start_m_ = to_shoulder(plan_, *settings.shoulder_m);
  pose_.height_m = plan_.height_m;
  tool_.position_m = Vector3d(0.0, 0.0, 0.05);
  update(0.0, tool_, {});
  begun_ = false;
}

void Figure::go_on_with(const Vector3d& tool_grip_m) {
  settings_.grip_m = tool_grip_m;
  begun_ = false;
}

const FigurePose& Figure::update(double time_s, const Pose& tool, const TrackedOperator& bodies) {
  // A step back is another clock: all bindings are invalid.
  if (begun_ && time_s < time_s_) *this = Figure(settings_);
  // Limited, so that nothing jumps after a pause of the page.
  dt_s_ = begun_ ? std::clamp(time_s - time_s_, 0.0, kLongestStep_s) : 0.0;
  time_s_ = time_s;
  begun_ = true;
  if (is_good(tool)) tool_ = tool;
  if (!may_bind_) settle(bodies);
  // In this order: the arm starts at the trunk, the head at the chest that the arm has bent.
  pose_trunk(bodies);
  pose_arm(tool_, bodies);
  pose_head();
  pose_left_arm(bodies);
  place_leg(false, bodies);
  place_leg(true, bodies);
  report(bodies, pose_);
  return pose_;
}

/// Before any body is bound, moves the figure so that its right shoulder meets the tracked one.
/// Waits up to kWaitForShoulder_s for the shoulder.
void Figure::settle(const TrackedOperator& bodies) {
  const auto is_seen = [](const TrackedBody& body) {
    return body.state == BodyState::kTracked && is_good(body.pose);
  };
  const TrackedBody& shoulder = bodies[BodyRole::kShoulder];
  if (!place_goal_m_) {
    if (!std::any_of(bodies.bodies.begin(), bodies.bodies.end(), is_seen)) return;
    waited_s_ += dt_s_;
    if (is_seen(shoulder)) {
      const Vector3d by_m = to_shoulder(plan_, shoulder.pose.position_m);
      pose_.shoulder_too_far = !((by_m - start_m_).norm() <= kMaxPosition_m);
      place_goal_m_ = pose_.shoulder_too_far ? start_m_ : by_m;
    } else if (shoulder.state == BodyState::kAbsent || waited_s_ > kWaitForShoulder_s) {
      // No shoulder in the description, or not seen in time: use the untracked place.
      place_goal_m_ = start_m_;
    } else {
      return;
    }
    waited_s_ = 0.0;
  }
  waited_s_ += dt_s_;
  const Vector3d way = *place_goal_m_ - start_m_;
  const double way_m = way.norm();
  const double way_s = way_m > 0.0 ? std::max(kReturn_s, way_m / kGlide_mps) : 0.0;
  const double t = way_s > waited_s_ ? waited_s_ / way_s : 1.0;
  // 3 t^2 - 2 t^3: zero speed at both ends.
  place_m_ = start_m_ + t * t * (3.0 - 2.0 * t) * way;
  may_bind_ = t >= 1.0;
}

const Pose& Figure::follow(BodyRole role, const TrackedOperator& bodies, const Pose& neutral) {
  // Before the figure is at its place, binding would store the wrong offset.
  const TrackedBody absent{};
  return bones_[static_cast<std::size_t>(role)].follow(may_bind_ ? bodies[role] : absent, neutral,
                                                       dt_s_);
}

void Figure::pose_trunk(const TrackedOperator& bodies) {
  pelvis_ = follow(BodyRole::kWaist, bodies, placed(standing_pelvis(plan_), place_m_));
  arm_.relax(1.0 - std::exp(-dt_s_ / kRelax_s));
  const auto upright = [this](FigureJoint joint, const Quaterniond& turn) {
    return Pose{.rotation = pelvis_.rotation * turn,
                .position_m = pose::to_world(pelvis_, upright_m(plan_, joint))};
  };
  const Pose shoulder = follow(BodyRole::kShoulder, bodies,
                               upright(FigureJoint::kRightShoulder, Quaterniond::Identity()));
  const Pose head = follow(BodyRole::kHead, bodies, upright(FigureJoint::kHead, looking_down()));
  const double by_shoulder = share(BodyRole::kShoulder);
  // The shoulder has precedence: the head leads the trunk only by the remaining share.
  const double by_head = (1.0 - by_shoulder) * share(BodyRole::kHead);
  arm_.lean(TrunkEnd::kChest,
            pose::to_local(pelvis_, head.position_m) - plan_.neck_m * Vector3d::UnitZ(), by_head);
  arm_.lean(TrunkEnd::kShoulder, pose::to_local(pelvis_, shoulder.position_m), by_shoulder);
}

void Figure::pose_arm(const Pose& tool, const TrackedOperator& bodies) {
  using enum FigureJoint;
  const Vector3d grip_m = pose::to_world(tool, settings_.grip_m);
  // Hand and wrist are bound to the hand's pose at the tool.
  const Pose held{.rotation = tool.rotation * holding_hand(), .position_m = grip_m};
  const Pose wrist = follow(BodyRole::kWrist, bodies, held);
  const Pose hand = follow(BodyRole::kHand, bodies, held);
  // A tracker on the hand is more accurate than one on the wrist.
  const Quaterniond turn = wrist.rotation.slerp(share(BodyRole::kHand), hand.rotation);
  // Bound to the elbow of the last frame; after a loss the arm returns to rest.
  const Pose elbow = follow(BodyRole::kElbow, bodies, {.position_m = pose_[kRightElbow]});
  ArmGoal goal{.grip_m = pose::to_local(pelvis_, grip_m),
               .hand = (pelvis_.rotation.conjugate() * turn).normalized()};
  if (share(BodyRole::kElbow) > 0.0) goal.elbow_m = pose::to_local(pelvis_, elbow.position_m);
  pose_.arm = arm_.hold(goal);
  pose_.grip_m = grip_m;
  constexpr std::array kPoints{kPelvis,     kBack,       kChest,         kRightShoulder,
                               kRightElbow, kRightWrist, kRightKnuckles, kRightFingers};
  for (std::size_t i = 0; i < kPoints.size(); ++i)
    pose_[kPoints[i]] = pose::to_world(pelvis_, arm_.points_m()[i]);
}

void Figure::pose_head() {
  const Pose& head = bones_[static_cast<std::size_t>(BodyRole::kHead)].now();
  const double by_tracker = share(BodyRole::kHead);
  const Quaterniond thorax = pelvis_.rotation * arm_.axes(kThoraxBone),
                    free = thorax * looking_down();
  const Vector3d up = thorax * Vector3d::UnitZ(), chest_m = pose_[FigureJoint::kChest];
  // The neck points to the tracked head and keeps its own length.
  const Quaterniond neck = Quaterniond::FromTwoVectors(up, head.position_m - chest_m);
  pose_[FigureJoint::kHead] =
      chest_m + at_most(part_of(neck, by_tracker), kNeckCone_rad) * (plan_.neck_m * up);
  // The turn from the trunk's own axes is limited.
  const Quaterniond turn = thorax.conjugate() * free.slerp(by_tracker, head.rotation);
  pose_.head = (thorax * at_most(turn, kHeadTurn_rad)).normalized();
  pose_[FigureJoint::kCrown] =
      pose_[FigureJoint::kHead] + pose_.head * (plan_.head_m * Vector3d::UnitZ());
}

/// Without a tracker the left hand rests on the bench's edge and moves with the trunk.
void Figure::pose_left_arm(const TrackedOperator& bodies) {
  using enum FigureJoint;
  const Quaterniond thorax = pelvis_.rotation * arm_.axes(kThoraxBone);
  const Vector3d shoulder_m = pose_[kChest] - thorax * (plan_.clavicle_m * Vector3d::UnitY());
  // The rest pose in the thorax's axes, chosen by eye.
  const auto bone = [](double length_m, const Vector3d& along) -> Vector3d {
    return length_m * along.normalized();
  };
  const Vector3d elbow_m = bone(plan_.upper_arm_m, {-0.22, -0.18, -0.95}),
                 wrist_m = elbow_m + bone(plan_.forearm_m, {-0.93, 0.28, -0.12}),
                 palm_m = bone(plan_.palm_m, {-0.88, 0.30, -0.35}),
                 fingers_m = bone(plan_.fingers_m, {-0.75, 0.30, -0.55});
  const Pose hand = follow(BodyRole::kLeftHand, bodies,
                           {.rotation = thorax, .position_m = shoulder_m + thorax * wrist_m});
  // Down and outward, in the plane of the resting arm, so that binding the hand moves no elbow.
  const Vector3d hint = elbow_m - kElbowHint * wrist_m;
  const Limb arm = pose_limb({.upper_m = plan_.upper_arm_m, .lower_m = plan_.forearm_m}, shoulder_m,
                             hand.position_m, thorax * hint, thorax * Vector3d::UnitX());
  pose_.left_hand_reached = share(BodyRole::kLeftHand) == 0.0 || arm.missed_m <= kLimbTolerance_m;
  pose_[kLeftShoulder] = shoulder_m;
  pose_[kLeftElbow] = arm.middle_m;
  pose_[kLeftWrist] = arm.end_m;
  pose_[kLeftKnuckles] = arm.end_m + hand.rotation * palm_m;
  pose_[kLeftFingers] = pose_[kLeftKnuckles] + hand.rotation * fingers_m;
}

void Figure::place_leg(bool right, const TrackedOperator& bodies) {
  using enum FigureJoint;
  const auto pick = [right](FigureJoint r, FigureJoint l) { return right ? r : l; };
  const Vector3d hip_m = pose::to_world(pelvis_, upright_m(plan_, pick(kRightHip, kLeftHip)));
  const Vector3d standing_m = standing_ankle_m(plan_, right) + place_m_;
  const BodyRole ankle = right ? BodyRole::kRightAnkle : BodyRole::kLeftAnkle;
  const Pose foot = follow(ankle, bodies, {.position_m = standing_m});
  // Hint for the knee: forward of the leg, or the position of the tracked leg.
  const Vector3d forward = pelvis_.rotation * -Vector3d::UnitX();
  const Vector3d knee_hint_m = 0.5 * (hip_m + foot.position_m) + 0.1 * forward;
  const Pose shin =
      follow(right ? BodyRole::kRightLeg : BodyRole::kLeftLeg, bodies, {.position_m = knee_hint_m});
  const Limb leg = pose_limb({.upper_m = plan_.thigh_m, .lower_m = plan_.calf_m}, hip_m,
                             foot.position_m, shin.position_m - hip_m, forward);
  // Without a tracker the figure sets the foot itself, so there is nothing to report.
  pose_.leg_reached[right ? 1 : 0] = share(ankle) == 0.0 || leg.missed_m <= kLimbTolerance_m;
  pose_[pick(kRightHip, kLeftHip)] = hip_m;
  pose_[pick(kRightKnee, kLeftKnee)] = leg.middle_m;
  pose_[pick(kRightAnkle, kLeftAnkle)] = leg.end_m;
  pose_[pick(kRightToes, kLeftToes)] =
      leg.end_m + foot.rotation * (plan_.foot_m * Vector3d(-0.95, 0.0, -0.31).normalized());
}

}  // namespace tact::host::figure
