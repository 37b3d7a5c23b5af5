// SPDX-License-Identifier: Apache-2.0
#include "host/igtl/igtl_bodies.h"

#include <cctype>
#include <string>

#include "host/tracking/tracking_setup.h"

namespace tact::host::igtl {
namespace {

using tracking::BodyRole;
using tracking::TrackedOperator;
using tracking::TrackedSample;

/// The part before a "To" that a capital letter follows.
std::string_view own_name(std::string_view device) {
  // PLUS writes FROMToTO; the capital after "To" distinguishes it from a name such as "Tool".
  for (std::size_t at = 1; at + 2 < device.size(); ++at)
    if (device.substr(at, 2) == "To" && std::isupper(static_cast<unsigned char>(device[at + 2])))
      return device.substr(0, at);
  return device;
}

/// Case and '_' do not matter: "LeftLeg" is left_leg.
std::string letters_of(std::string_view name) {
  std::string out;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)))
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

TrackedSample sample_of(const pose::Pose& pose, double time_s, std::uint64_t sequence) {
  const Eigen::Vector3d& p = pose.position_m;
  const Eigen::Quaterniond& q = pose.rotation;
  return {.time_s = time_s,
          .sequence = sequence,
          .value = {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}};
}

}  // namespace

std::optional<BodyRole> role_of(std::string_view device) {
  const std::string name = letters_of(own_name(device));
  for (std::size_t i = 0; i < tracking::kBodyRoles; ++i) {
    const auto role = static_cast<BodyRole>(i);
    if (name == letters_of(tracking::name_of(role))) return role;
  }
  return std::nullopt;
}

void IgtlBodies::take(BodyRole role, const pose::Pose& pose, double sent_s, double now_s) {
  std::optional<Body>& body = bodies_[static_cast<std::size_t>(role)];
  if (!body) body.emplace();
  // A constant time with a changing position is not the pose's time: from now on arrival counts.
  const bool frozen = sent_s == body->sent_s && pose.position_m != body->position_m;
  body->has_clock = body->has_clock && sent_s > 0.0 && !frozen;
  body->sent_s = sent_s;
  body->position_m = pose.position_m;
  const double time_s = body->has_clock ? sent_s : now_s;
  if (!body->tracker.admit(0, sample_of(pose, time_s, ++body->samples), now_s)) return;
  body->tracker.take({.status = pose::PoseStatus::kOk, .pose = pose}, time_s, now_s);
}

TrackedOperator IgtlBodies::at(double now_s) const {
  TrackedOperator out{.time_s = now_s};
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    if (bodies_[i]) out.bodies[i] = bodies_[i]->tracker.at(now_s);
  return out;
}

TrackedOperator joined(const TrackedOperator& first, const TrackedOperator& second) {
  TrackedOperator out = first;
  for (std::size_t i = 0; i < out.bodies.size(); ++i)
    // Only absent ones: a lost body of the description has precedence all the same.
    if (out.bodies[i].state == tracking::BodyState::kAbsent) out.bodies[i] = second.bodies[i];
  return out;
}

}  // namespace tact::host::igtl
