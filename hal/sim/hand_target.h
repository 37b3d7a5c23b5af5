// SPDX-License-Identifier: Apache-2.0
// hand_target.h - one datagram that moves the simulated hand, never the tool and never a force.
//
// 64 bytes, little-endian, to the socket that the simulated device listens on (hand_socket.h).
#pragma once

#include <cstdint>
#include <type_traits>

namespace tact::hal::sim {

inline constexpr std::uint32_t kHandTargetMagic = 0x74636174;  // "tact"
inline constexpr std::uint16_t kHandTargetVersion = 2;

struct HandTarget {
  std::uint32_t magic = kHandTargetMagic;
  std::uint16_t version = kHandTargetVersion;
  std::uint16_t pad = 0;
  double position_m[3] = {};    // of the tool, W
  double rotation_rad[3] = {};  // of the tool against its rest orientation, rotation vector in W
  double grip_ratio = 0.0;      // 0 open, 1 closed
};

static_assert(std::is_trivially_copyable_v<HandTarget> && sizeof(HandTarget) == 64);

}  // namespace tact::hal::sim
