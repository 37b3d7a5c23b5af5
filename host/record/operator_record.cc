// SPDX-License-Identifier: Apache-2.0
#include "host/record/operator_record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "host/figure/figure_text.h"

namespace tact::host::record {

const char* body_state(std::uint64_t number) {
  static constexpr std::array kNames{"absent", "tracked", "held", "lost"};
  return number < kNames.size() ? kNames[number] : "unknown";
}

namespace {

using firmware::protocol::kWxyz;

constexpr auto kLastState = tracking::BodyState::kLost;
constexpr auto kLastTrouble = tracking::TrackingTrouble::kOutOfOrder;

#define FIELD(member, meaning) TACT_FIELD(BodyRecord, member, #member, meaning)
constexpr std::array kBody{
    FIELD(raw_position_m, "as solved"),
    FIELD(raw_rotation_wxyz, "unit quaternion from the body's frame to W").with_components(kWxyz),
    FIELD(shown_position_m, "filtered"),
    FIELD(shown_rotation_wxyz, "filtered").with_components(kWxyz),
    FIELD(rms_px, "reprojection error"),
    FIELD(age_s, "since its last good pose"),
    FIELD(state, "").labelled(body_state),
    FIELD(trouble, "number of TrackingTrouble (host/tracking/tracked_operator.h)")};
#undef FIELD

#define FIELD(member, meaning) TACT_FIELD(FigureRecord, member, #member, meaning)
constexpr std::array kFigure{FIELD(height_m, "0: no figure was shown"),
                             FIELD(joint_m, "in the order of figure.h"),
                             FIELD(head_wxyz, "unit quaternion to W").with_components(kWxyz),
                             FIELD(grip_m, "of the right hand on the tool"),
                             FIELD(error_m, "of the hand from the grip"),
                             FIELD(sweeps, "of the solver"),
                             FIELD(updates, "of the solver"),
                             FIELD(reached, "the hand is at the grip"),
                             FIELD(out_of_reach, ""),
                             FIELD(full_chain, "the trunk moved, too"),
                             FIELD(left_leg_reached, ""),
                             FIELD(right_leg_reached, ""),
                             FIELD(shoulder_too_far, ""),
                             FIELD(left_hand_missed, "")};
#undef FIELD

#define FIELD(member, meaning) TACT_FIELD(OperatorRecord, member, #member, meaning)
constexpr std::array kOperator{
    FIELD(time_s, "of the tracker"),
    FIELD(body, "in the order of BodyRole (host/tracking/tracked_operator.h)"),
    FIELD(figure, "as it was shown")};
#undef FIELD

template <typename T>
void put(const pose::Pose& pose, T (&position_m)[3], T (&rotation_wxyz)[4]) {
  const Eigen::Quaterniond& q = pose.rotation;
  const double wxyz[4] = {q.w(), q.x(), q.y(), q.z()};
  std::ranges::transform(wxyz, rotation_wxyz, [](double part) { return static_cast<T>(part); });
  std::ranges::transform(pose.position_m, position_m, [](double m) { return static_cast<T>(m); });
}

template <typename T>
std::optional<pose::Pose> take(const T (&position_m)[3], const T (&wxyz)[4]) {
  double p[3], q[4];
  std::ranges::transform(position_m, p, [](T m) { return static_cast<double>(m); });
  std::ranges::transform(wxyz, q, [](T part) { return static_cast<double>(part); });
  pose::Pose out{.rotation = {q[0], q[1], q[2], q[3]}, .position_m = {p[0], p[1], p[2]}};
  // Float rounding of a unit quaternion is 1e-7; 1e-3 is damage.
  const bool is_turn = std::abs(out.rotation.norm() - 1.0) < 1e-3;
  if (!is_turn || !out.position_m.allFinite()) return std::nullopt;
  return out;
}

std::optional<tracking::TrackedBody> take(const BodyRecord& record) {
  const auto raw = take(record.raw_position_m, record.raw_rotation_wxyz);
  const auto shown = take(record.shown_position_m, record.shown_rotation_wxyz);
  // An enum from a file may hold any value.
  if (!raw || !shown || record.state > kLastState || record.trouble > kLastTrouble) return {};
  if (!std::isfinite(record.rms_px) || !std::isfinite(record.age_s)) return {};
  return tracking::TrackedBody{
      .state = record.state,
      .trouble = record.trouble,
      .pose = {.rotation = shown->rotation.normalized(), .position_m = shown->position_m},
      .raw = *raw,
      .rms_px = static_cast<double>(record.rms_px),
      .age_s = static_cast<double>(record.age_s)};
}

FigureRecord record_of(const figure::FigurePose& pose) {
  FigureRecord out{.height_m = pose.height_m,
                   .error_m = static_cast<float>(pose.arm.error_m),
                   .sweeps = static_cast<std::uint16_t>(pose.arm.sweeps),
                   .updates = static_cast<std::uint16_t>(pose.arm.updates),
                   .reached = pose.arm.reached,
                   .out_of_reach = pose.arm.out_of_reach,
                   .full_chain = pose.arm.full_chain};
  for (std::size_t i = 0; i < figure::kFigureJoints; ++i)
    Eigen::Vector3f::Map(out.joint_m[i]) = pose.joint_m[i].cast<float>();
  put({.rotation = pose.head, .position_m = pose.grip_m}, out.grip_m, out.head_wxyz);
  out.shoulder_too_far = pose.shoulder_too_far;
  out.left_hand_missed = !pose.left_hand_reached;
  out.left_leg_reached = pose.leg_reached[0];
  out.right_leg_reached = pose.leg_reached[1];
  return out;
}

}  // namespace

std::string operator_chunk(const tracking::TrackedOperator& tracked,
                           const figure::FigurePose* figure) {
  OperatorRecord record{.time_s = tracked.time_s};
  for (std::size_t i = 0; i < tracking::kBodyRoles; ++i) {
    const tracking::TrackedBody& body = tracked.bodies[i];
    BodyRecord& out = record.body[i];
    put(body.raw, out.raw_position_m, out.raw_rotation_wxyz);
    put(body.pose, out.shown_position_m, out.shown_rotation_wxyz);
    out.rms_px = static_cast<float>(body.rms_px);
    out.age_s = static_cast<float>(body.age_s);
    out.state = body.state;
    out.trouble = body.trouble;
  }
  if (figure != nullptr) record.figure = record_of(*figure);
  return firmware::protocol::chunk_of(record);
}

firmware::protocol::FieldTable BodyRecord::fields() { return kBody; }
firmware::protocol::FieldTable FigureRecord::fields() { return kFigure; }
firmware::protocol::FieldTable OperatorRecord::fields() { return kOperator; }

std::optional<tracking::TrackedOperator> operator_of(const OperatorRecord& record) {
  // The chunk's CRC detects damage; these checks detect invalid data of another writer.
  if (!std::isfinite(record.time_s)) return std::nullopt;
  tracking::TrackedOperator out{.time_s = record.time_s};
  for (std::size_t i = 0; i < tracking::kBodyRoles; ++i) {
    const auto body = take(record.body[i]);
    if (!body) return std::nullopt;
    out.bodies[i] = *body;
  }
  return out;
}

std::optional<figure::FigurePose> figure_of(const OperatorRecord& record,
                                            const tracking::TrackedOperator& bodies) {
  const FigureRecord& figure = record.figure;
  const auto grip = take(figure.grip_m, figure.head_wxyz);
  const bool is_there = figure.height_m > 0.0 && std::isfinite(figure.height_m);
  if (!is_there || !grip || !std::isfinite(figure.error_m)) return std::nullopt;
  figure::FigurePose out;
  out.height_m = figure.height_m;
  for (std::size_t i = 0; i < figure::kFigureJoints; ++i) {
    out.joint_m[i] = Eigen::Vector3f::Map(figure.joint_m[i]).cast<double>();
    if (!out.joint_m[i].allFinite()) return std::nullopt;
  }
  out.head = grip->rotation.normalized();
  out.grip_m = grip->position_m;
  out.arm = {.reached = figure.reached,
             .out_of_reach = figure.out_of_reach,
             .full_chain = figure.full_chain,
             .error_m = static_cast<double>(figure.error_m),
             .sweeps = figure.sweeps,
             .updates = figure.updates};
  out.leg_reached = {figure.left_leg_reached, figure.right_leg_reached};
  out.shoulder_too_far = figure.shoulder_too_far;
  out.left_hand_reached = !figure.left_hand_missed;
  // Trouble and words are not in the file; report() derives them.
  report(bodies, out);
  return out;
}

}  // namespace tact::host::record
