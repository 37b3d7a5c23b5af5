// SPDX-License-Identifier: Apache-2.0
// odrive_axis.h - one ODrive in the loop: its state, and whether a position is taken.
//
// CANSimple numbers no message. What is known of a position: that a newer one has come already
// (by the kernel's stamp); that it is the last one again, bit for bit, while its velocity says that
// the motor has moved; that it is too far from the last one for its velocities:
//
//     |p - p_last - (v + v_last) T / 2| > 0.02 turn + |v| 2 ms + 1000 turn/s^2 T^2
//
// The same value twice at rest is legal. What an adapter swaps within one tick cannot be detected.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "hal/can/can_device.h"
#include "hal/odrive/odrive_protocol.h"

namespace tact::hal::odrive {

enum class OdriveNews : std::uint8_t {
  kNew,
  kOld,     // older than the newest
  kStale,   // the last one again, while it moves
  kJumped,  // too far away: not taken
};

class OdriveAxis {
 public:
  // 3 a jump, less 1 a position that is taken. Then the encoder is not to be trusted: after three
  // jumps in a row, or the fourth of positions that two drives with one node id send in turn.
  static constexpr int kMaxJumpScore = 9;

  std::uint8_t state = 0;  // OdriveAxisState of the last heartbeat
  bool is_in(OdriveAxisState one) const RT_SAFE { return state == static_cast<std::uint8_t>(one); }

  /// What is new goes to `axis`, which has the one before.
  OdriveNews take(const OdriveEstimates& now, std::int64_t arrival_ns, can::CanAxis& axis) RT_SAFE {
    if (axis.located) {
      if (arrival_ns < axis.arrival_ns) return OdriveNews::kOld;
      const double dt_s = 1e-9 * static_cast<double>(arrival_ns - axis.arrival_ns);
      const double speed_turns_per_s = std::abs(now.velocity_turns_per_s);
      if (same_bits(now.position_turns, axis.motor_turns) &&
          same_bits(now.velocity_turns_per_s, velocity_turns_per_s_) &&
          speed_turns_per_s * dt_s > kMoved_turns) {
        return OdriveNews::kStale;
      }
      const double moved_turns = 0.5 * (now.velocity_turns_per_s + velocity_turns_per_s_) * dt_s;
      const double residual_turns = std::abs(now.position_turns - axis.motor_turns - moved_turns);
      const double most_turns =
          kSlack_turns + speed_turns_per_s * kStampError_s + kHalfMost_turns_per_s2 * dt_s * dt_s;
      if (!(residual_turns <= most_turns)) {
        jump_score_ += 3;
        axis.jumps = jump_score_ >= kMaxJumpScore;
        return OdriveNews::kJumped;
      }
    }
    jump_score_ = std::max(jump_score_ - 1, 0);
    velocity_turns_per_s_ = now.velocity_turns_per_s;
    axis.sample(now.position_turns, arrival_ns);
    return OdriveNews::kNew;
  }

 private:
  static constexpr double kSlack_turns = 0.02;   // backlash of stamps at low speed, encoder ripple
  static constexpr double kStampError_s = 2e-3;  // the kernel may stamp a frame late
  static constexpr double kHalfMost_turns_per_s2 =
      1000.0;                                   // half of what a motor of this size can do
  static constexpr double kMoved_turns = 1e-5;  // an estimate that moved so far has other bits

  static bool same_bits(double a, double b) RT_SAFE {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
  }

  double velocity_turns_per_s_ = 0.0;  // of the last one taken
  int jump_score_ = 0;
};

}  // namespace tact::hal::odrive
