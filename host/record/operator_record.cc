// SPDX-License-Identifier: Apache-2.0
#include "host/record/operator_record.h"

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <cmath>
#include <cstddef>

#include "host/figure/figure_text.h"

namespace tact::host::record {
namespace {

constexpr auto kLastState = static_cast<std::uint8_t>(tracking::BodyState::kLost);
constexpr auto kLastTrouble = static_cast<std::uint8_t>(tracking::TrackingTrouble::kOutOfOrder);

constexpr std::array<std::uint8_t, 2> kLegReached{kLeftLegReached, kRightLegReached};

std::uint32_t crc_of(const OperatorRecord& record) {
  boost::crc_32_type crc;
  // Includes the padding, which is zero in every record.
  crc.process_bytes(&record, offsetof(OperatorRecord, crc));
  return crc.checksum();
}

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
      .state = static_cast<tracking::BodyState>(record.state),
      .trouble = static_cast<tracking::TrackingTrouble>(record.trouble),
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
  if (pose.shoulder_too_far) out.flags |= kShoulderTooFar;
  if (!pose.left_hand_reached) out.flags |= kLeftHandMissed;
  for (std::size_t i = 0; i < pose.leg_reached.size(); ++i)
    if (pose.leg_reached[i]) out.flags |= kLegReached[i];
  return out;
}

}  // namespace

std::string operator_record(const tracking::TrackedOperator& tracked,
                            const figure::FigurePose* figure) {
  OperatorRecord record{.time_s = tracked.time_s};
  for (std::size_t i = 0; i < tracking::kBodyRoles; ++i) {
    const tracking::TrackedBody& body = tracked.bodies[i];
    BodyRecord& out = record.body[i];
    put(body.raw, out.raw_position_m, out.raw_rotation_wxyz);
    put(body.pose, out.shown_position_m, out.shown_rotation_wxyz);
    out.rms_px = static_cast<float>(body.rms_px);
    out.age_s = static_cast<float>(body.age_s);
    out.state = static_cast<std::uint8_t>(body.state);
    out.trouble = static_cast<std::uint8_t>(body.trouble);
  }
  if (figure != nullptr) record.figure = record_of(*figure);
  record.crc = crc_of(record);
  return {reinterpret_cast<const char*>(&record), sizeof record};
}

std::optional<tracking::TrackedOperator> operator_of(const OperatorRecord& record) {
  // The CRC detects damage; the checks after it detect invalid data of another writer.
  if (crc_of(record) != record.crc || !std::isfinite(record.time_s)) return std::nullopt;
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
  out.arm = {.reached = figure.reached != 0,
             .out_of_reach = figure.out_of_reach != 0,
             .full_chain = figure.full_chain != 0,
             .error_m = static_cast<double>(figure.error_m),
             .sweeps = figure.sweeps,
             .updates = figure.updates};
  for (std::size_t i = 0; i < out.leg_reached.size(); ++i)
    out.leg_reached[i] = (figure.flags & kLegReached[i]) != 0;
  out.shoulder_too_far = (figure.flags & kShoulderTooFar) != 0;
  out.left_hand_reached = (figure.flags & kLeftHandMissed) == 0;
  // Trouble and words are not in the file; report() derives them.
  report(bodies, out);
  return out;
}

}  // namespace tact::host::record
