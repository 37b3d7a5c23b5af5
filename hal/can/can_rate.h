// SPDX-License-Identifier: Apache-2.0
// can_rate.h - how fast a CAN bus is, and how long it takes for so many bits.
//
// Frames are twice as long on a bus at half the rate: the force is later, and less stiffness is
// sound (HL-1). Set-up code only.
#pragma once

#include "hal/can/can_fd_frame.h"

namespace tact::hal::can {

/// bit/s, > 0. A virtual bus tells none; it counts as one that is set up as kLinkType says.
struct CanRate {
  double slow_bps = kCanFdSlow_bps;  // classic CAN has this one alone
  double fast_bps = kCanFdFast_bps;  // of CAN FD, behind the bit rate switch
};

constexpr double bus_time_s(int bits, const CanRate& rate) { return bits / rate.slow_bps; }
constexpr double bus_time_s(const CanFdBits& bits, const CanRate& rate) {
  return bits.slow / rate.slow_bps + bits.fast / rate.fast_bps;
}

}  // namespace tact::hal::can
