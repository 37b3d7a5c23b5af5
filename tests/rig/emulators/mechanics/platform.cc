// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/mechanics/platform.h"

#include <algorithm>
#include <cmath>

namespace tact::rig {
namespace {

constexpr std::int64_t kStep_ns = 250'000, kLongestCatchUp_ns = 20'000'000;
constexpr double kStick_radps = 0.02;  // Coulomb friction grows from zero over this

struct Leg {  // of the hand's path: it arrives at `end_s`
  double end_s;
  double down, aside;  // shares of the way
};
constexpr Leg kPath[] = {{0.5, 0, 0}, {2.0, 1, 0}, {2.5, 1, 0}, {3.3, 1, 1},
                         {3.7, 1, 1}, {5.0, 0, 1}, {5.5, 0, 0}, {6.0, 0, 0}};
constexpr double kPeriod_s = 6.0;

}  // namespace

HandTarget hand_target(const Hand& hand, double time_s) {
  const double t_s = std::fmod(hand.tempo * time_s, kPeriod_s);
  Leg from{0.0, 0.0, 0.0};
  for (const Leg& to : kPath) {
    if (t_s >= to.end_s) {
      from = to;
      continue;
    }
    // Minimum jerk (Flash and Hogan 1985): w = 10 s^3 - 15 s^4 + 6 s^5.
    const double span_s = to.end_s - from.end_s, s = (t_s - from.end_s) / span_s;
    const double way = s * s * s * (10.0 + s * (6.0 * s - 15.0));
    const double rate_per_s = 30.0 * s * s * (1.0 - s) * (1.0 - s) * hand.tempo / span_s;
    const Vec3 span{0.0, hand.slide_m, hand.bottom_m - hand.top_m};
    const Vec3 change{0.0, span.y * (to.aside - from.aside), span.z * (to.down - from.down)};
    const Vec3 start{0.0, span.y * from.aside, hand.top_m + span.z * from.down};
    return {hand.centre_m + start + way * change, rate_per_s * change};
  }
  return {hand.centre_m + Vec3{0.0, 0.0, hand.top_m}, {}};
}

Platform::Platform(const Mechanism& mechanism, const Hand& hand, std::int64_t now_ns)
    : mechanism_(mechanism), hand_(hand), time_ns_(now_ns) {
  position_m_ = hand_target(hand_, 0.0).position_m;
  lowest_z_m_ = position_m_.z;
  if (const auto start = mechanism_.pose(position_m_)) pose_ = *start;
}

void Platform::release(std::int64_t now_ns) {
  if (released_ns_ == 0) released_ns_ = now_ns;
}

Joints Platform::joint_velocity_radps() const {
  Joints rate_radps{};
  for (std::size_t i = 0; i < 3; ++i)
    rate_radps[i] = model::dot(pose_.k_rad_per_m[i], velocity_mps_);
  return rate_radps;
}

void Platform::advance(std::int64_t now_ns, const Joints& tau_Nm) {
  time_ns_ = std::max(time_ns_, now_ns - kLongestCatchUp_ns);
  for (; time_ns_ + kStep_ns <= now_ns; time_ns_ += kStep_ns)
    step(1e-9 * static_cast<double>(kStep_ns), tau_Nm);
}

void Platform::step(double dt_s, const Joints& tau_Nm) {
  const double path_s =
      released_ns_ == 0
          ? 0.0
          : 1e-9 * static_cast<double>(std::max<std::int64_t>(0, time_ns_ - released_ns_));
  HandTarget hand = hand_target(hand_, path_s);
  hand.position_m += pull_m_;
  const Joints rate_radps = joint_velocity_radps();
  Joints torque_Nm{};
  for (std::size_t i = 0; i < 3; ++i) {
    torque_Nm[i] = tau_Nm[i] - mechanism_.viscous_Nms_per_rad() * rate_radps[i] -
                   mechanism_.coulomb_Nm() * std::tanh(rate_radps[i] / kStick_radps);
  }
  const Vec3 force_N = force_of(pose_, torque_Nm) + pose_.weight_N +
                       hand_.stiffness_N_per_m * (hand.position_m - position_m_) +
                       hand_.damping_Ns_per_m * (hand.velocity_mps - velocity_mps_);
  velocity_mps_ += force_N * (dt_s / (mechanism_.mass_kg() + hand_.mass_kg));
  const Vec3 next_m = position_m_ + velocity_mps_ * dt_s;
  const auto pose = mechanism_.pose(next_m);
  if (!pose) {  // at the stops: it stays
    velocity_mps_ = {};
    return;
  }
  travel_m_ += model::norm(next_m - position_m_);
  position_m_ = next_m;
  pose_ = *pose;
  lowest_z_m_ = std::min(lowest_z_m_, position_m_.z);
}

}  // namespace tact::rig
