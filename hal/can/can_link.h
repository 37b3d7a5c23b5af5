// SPDX-License-Identifier: Apache-2.0
// can_link.h - checks once, before the loop, that a CAN interface is fit for control.
//
// The kernel's answer to RTM_GETLINK (rtnetlink(7), linux/if_link.h, linux/can/netlink.h):
//
//     nlmsghdr 16 bytes, ifinfomsg 16 bytes (type u16 at 2, index i32 at 4, flags u32 at 8), then
//     attributes: length u16, type u16, value, padded to 4:  MTU 4 u32, LINKINFO 18 { KIND 1, DATA
//     2 { BITTIMING 1 { bit rate u32, .. }, STATE 4 u32, RESTART_MS 6 u32, DATA_BITTIMING 9 } }
//
// An MTU of 72 says that the interface carries CAN FD. A virtual bus (vcan, vxcan) has no DATA: no
// bit rate, no state, nothing to refuse. The administrator configures the interface; tact does not
// change it. Set-up code only.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "hal/can/can_fd_frame.h"
#include "hal/can/can_frame.h"
#include "hal/permission.h"

namespace tact::hal::can {

/// Bytes before a netlink message's body (nlmsghdr), and in it before a link's attributes
/// (ifinfomsg).
inline constexpr std::size_t kNetlinkHeader_bytes = 16, kNetlinkLinkHeader_bytes = 16;

/// States of the controller, in the kernel's order.
enum class CanLinkState : std::uint32_t {
  kActive,
  kWarning,
  kPassive,
  kBusOff,
  kStopped,
  kSleeping,
};

struct CanLink {
  int index = 0;
  bool is_can = false;
  bool up = false;
  bool only_local = false;      // vcan: a bus that ends in this kernel's loopback
  bool has_controller = false;  // with bits on a wire; a virtual bus has none
  bool carries_fd = false;
  std::optional<std::uint32_t> bitrate;         // bit/s; of CAN FD the slow one
  std::optional<std::uint32_t> fast_bitrate{};  // of CAN FD
  std::optional<CanLinkState> state;
  std::optional<std::uint32_t> restart_ms;

  CanRate rate() const;
};

/// The link of one netlink message; nothing if it is no link or is cut short.
std::optional<CanLink> decode_can_link(std::span<const std::uint8_t> message);

/// Why the interface is refused, or none. `cycle_bits`: all frames of a tick, most stuff bits.
std::optional<Refusal> check_can_link(const CanLink& link, const std::string& name, int cycle_bits,
                                      double rate_Hz);

/// The same for CAN FD.
std::optional<Refusal> check_can_link(const CanLink& link, const std::string& name,
                                      const CanFdBits& cycle, double rate_Hz);

}  // namespace tact::hal::can
