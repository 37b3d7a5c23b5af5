// odrive_axis.h - what the loop knows of one ODrive: its state, its newest position, its silence.
//
// CANSimple numbers no message. What can be told of a position: that a newer one has come already
// (by the kernel's stamp); that it is the last one again, bit for bit, while its velocity says that
// the motor has moved; that it is too far from the last one for its velocities:
//
//     |p - p_last - (v + v_last) T / 2| > 0.02 turn + |v| 2 ms + 1000 turn/s^2 T^2
//
// The same value twice at rest is legal. What an adapter swaps within one tick cannot be told.
#pragma once

#include <cstdint>

#include "hal/odrive/odrive_protocol.h"

namespace tact::hal {

enum class OdriveNews : std::uint8_t {
  kNew,
  kOld,     // older than the newest
  kStale,   // the last one again, while it moves
  kJumped,  // too far away: not taken
};

class OdriveAxis {
 public:
  static constexpr int kMostJumps = 3;  // in a row, then the encoder is not to be trusted

  OdriveNews take(const OdriveEstimates& now, std::int64_t arrival_ns) RT_SAFE;

  bool has_position() const RT_SAFE { return has_position_; }
  double position_turns() const RT_SAFE { return newest_.position_turns; }
  std::int64_t arrival_ns() const RT_SAFE { return arrival_ns_; }
  bool untrusted() const RT_SAFE { return jumps_ >= kMostJumps; }

  std::int64_t heartbeat_ns = 0;  // when the last one came
  std::uint8_t state = 0;         // OdriveAxisState of that one

 private:
  OdriveEstimates newest_{};
  std::int64_t arrival_ns_ = 0;
  bool has_position_ = false;
  int jumps_ = 0;
};

}  // namespace tact::hal
