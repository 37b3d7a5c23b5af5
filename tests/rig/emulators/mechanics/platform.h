// SPDX-License-Identifier: Apache-2.0
// platform.h - the platform as a point mass between the motors, gravity, friction and a hand.
//
//     m v' = K^T (tau - b theta' - c sign(theta')) + weight + k (x_h - x) + d (v_h - v)
//
// Semi-implicit Euler in steps of 0.25 ms behind CLOCK_MONOTONIC. After a pause the physics catches
// up at most 20 ms and drops the rest, so a stopped emulator does not explode. The hand follows a
// path of 6 s: rests above, goes down, holds, slides sideways, goes back up. Until `release` it
// stays at its first point. All in W, m, N, s.
#pragma once

#include <cstdint>

#include "tests/rig/emulators/mechanics/mechanism.h"

namespace tact::rig {

struct Hand {
  double stiffness_N_per_m = 600.0, damping_Ns_per_m = 15.0, mass_kg = 0.15;
  double top_m = 0.060, bottom_m = -0.010, slide_m = 0.020;
  double tempo = 1.0;  // the path so many times faster
  Vec3 centre_m{};
};

struct HandTarget {
  Vec3 position_m;
  Vec3 velocity_mps;
};
/// Where the hand pulls, `time_s` after its release; periodic.
HandTarget hand_target(const Hand& hand, double time_s);

class Platform {
 public:
  /// `mechanism` outlives the platform and reaches the whole path of the hand.
  Platform(const Mechanism& mechanism, const Hand& hand, std::int64_t now_ns);

  /// Let the torques of the joints act up to now.
  void advance(std::int64_t now_ns, const Joints& tau_Nm);
  /// From now the hand follows its path; again: nothing.
  void release(std::int64_t now_ns);
  /// Add to where the hand pulls, as a person who homes the device does.
  void pull(const Vec3& offset_m) { pull_m_ = offset_m; }

  const Pose& pose() const { return pose_; }
  const Vec3& position_m() const { return position_m_; }
  Joints joint_velocity_radps() const;
  /// What torques of the joints do to the hand: their force without the part that carries gravity.
  Vec3 hand_force_N(const Joints& tau_Nm) const { return force_of(pose_, tau_Nm) + pose_.weight_N; }
  double travel_m() const { return travel_m_; }
  double lowest_z_m() const { return lowest_z_m_; }

 private:
  void step(double dt_s, const Joints& tau_Nm);

  const Mechanism& mechanism_;
  Hand hand_;
  Pose pose_{};
  Vec3 position_m_{}, velocity_mps_{}, pull_m_{};
  std::int64_t time_ns_, released_ns_ = 0;
  double travel_m_ = 0.0, lowest_z_m_ = 0.0;
};

}  // namespace tact::rig
