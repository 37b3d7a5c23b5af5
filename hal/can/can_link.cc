// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_link.h"

#include <fmt/core.h>
#include <linux/rtnetlink.h>
#include <net/if.h>

#include <algorithm>
#include <vector>

#include "hal/can/little_endian.h"

namespace tact::hal::can {
namespace {

using model::Error;

constexpr std::uint16_t kLinkInfo = 18, kInfoKind = 1, kInfoData = 2;
constexpr std::uint16_t kMtu = 4;
constexpr std::uint16_t kCanBitTiming = 1, kCanState = 4, kCanRestartMs = 6, kCanFastTiming = 9;
constexpr std::uint16_t kCanHardware = 280;  // ARPHRD_CAN
constexpr double kMaxLoad = 0.95;

struct Attribute {
  std::uint16_t type = 0;
  std::span<const std::uint8_t> value;
};

/// All attributes of a list; an end that is cut off is left out.
std::vector<Attribute> attributes(std::span<const std::uint8_t> bytes) {
  std::vector<Attribute> out;
  while (bytes.size() >= 4) {
    const std::size_t length = get_u16(bytes, 0);
    if (length < 4 || length > bytes.size()) break;
    const auto type = static_cast<std::uint16_t>(get_u16(bytes, 2) & 0x3FFFu);  // without flags
    out.push_back({.type = type, .value = bytes.subspan(4, length - 4)});
    bytes = bytes.subspan(std::min((length + 3) & ~std::size_t{3}, bytes.size()));
  }
  return out;
}

void take_can_data(std::span<const std::uint8_t> data, CanLink& link) {
  for (const Attribute& one : attributes(data)) {
    if (one.value.size() < 4) continue;
    const std::uint32_t value = get_u32(one.value, 0);
    if (one.type == kCanBitTiming && value != 0) link.bitrate = value;
    if (one.type == kCanFastTiming && value != 0) link.fast_bitrate = value;
    if (one.type == kCanState) link.state = static_cast<CanLinkState>(value);
    if (one.type == kCanRestartMs) link.restart_ms = value;
  }
}

void take_link_info(std::span<const std::uint8_t> info, CanLink& link) {
  const auto parts = attributes(info);
  std::string kind;
  for (const Attribute& one : parts) {
    if (one.type != kInfoKind) continue;
    kind.assign(one.value.begin(), std::find(one.value.begin(), one.value.end(), 0));
  }
  link.only_local = kind == "vcan";
  link.has_controller = kind == "can";
  if (!link.has_controller) return;  // others have other data
  for (const Attribute& one : parts)
    if (one.type == kInfoData) take_can_data(one.value, link);
}

// A bus on which frames are not sent, with its remedy.
std::optional<Error> check_state(const CanLink& link, const std::string& name) {
  if (link.state == CanLinkState::kBusOff) {
    return Error{
        fmt::format("{0} is bus-off: check bit rate, termination and cable; then sudo ip "
                    "link set {0} down; sudo ip link set {0} up",
                    name)};
  }
  if (link.state == CanLinkState::kPassive) {
    return Error{
        fmt::format("{0} is error passive: is it at the drives' bit rate, are they powered "
                    "and both ends terminated? Then sudo ip link set {0} down; sudo ip "
                    "link set {0} up",
                    name)};
  }
  if (link.state == CanLinkState::kStopped || link.state == CanLinkState::kSleeping) {
    return Error{
        fmt::format("{0} sleeps: sudo ip link set {0} down; sudo ip link set {0} up", name)};
  }
  return std::nullopt;
}

// What every bus needs; `link_type` sets it up.
std::optional<Error> check_interface(const CanLink& link, const std::string& name,
                                     const char* link_type) {
  if (!link.is_can) {
    return Error{fmt::format(
        "{} is no CAN interface: set device.can.interface to one (ip -details link shows them)",
        name)};
  }
  if (link.only_local) {
    return Error{
        fmt::format("{} is a vcan, which carries nothing between programs that do not ask "
                    "for loopback: use a pair, sudo ip link add can0 type vxcan peer name "
                    "can1",
                    name)};
  }
  if (!link.up)
    return Error{fmt::format("{0} is down: sudo ip link set {0} up {1}", name, link_type)};
  if (link.restart_ms.value_or(0) != 0) {
    return Error{fmt::format(
        "{0} comes back by itself {1} ms after bus-off, into a force that is "
        "old by then: sudo ip link set {0} down; sudo ip link set {0} up {2} restart-ms 0",
        name, *link.restart_ms, link_type)};
  }
  // A serial adapter (slcan) that its daemon has set up tells none.
  if (link.has_controller && !link.bitrate) {
    return Error{
        fmt::format("{0} does not tell its bit rate, so nobody knows how late a force is: sudo ip "
                    "link set {0} down; sudo ip link set {0} up {1}",
                    name, link_type)};
  }
  return check_state(link, name);
}

}  // namespace

CanRate CanLink::rate() const {
  CanRate rate;
  if (bitrate) rate.slow_bps = *bitrate;
  if (fast_bitrate) rate.fast_bps = *fast_bitrate;
  return rate;
}

std::optional<CanLink> decode_can_link(std::span<const std::uint8_t> message) {
  if (message.size() < kNetlinkHeader_bytes + kNetlinkLinkHeader_bytes) return std::nullopt;
  const std::size_t length = get_u32(message, 0);
  if (length < kNetlinkHeader_bytes + kNetlinkLinkHeader_bytes || length > message.size())
    return std::nullopt;
  if (get_u16(message, 4) != RTM_NEWLINK) return std::nullopt;
  const auto body = message.subspan(kNetlinkHeader_bytes, length - kNetlinkHeader_bytes);
  CanLink link{.index = get_i32(body, 4),
               .is_can = get_u16(body, 2) == kCanHardware,
               .up = (get_u32(body, 8) & IFF_UP) != 0,
               .only_local = false,
               .has_controller = false,
               .carries_fd = false,
               .bitrate = {},
               .fast_bitrate = {},
               .state = {},
               .restart_ms = {}};
  for (const Attribute& one : attributes(body.subspan(kNetlinkLinkHeader_bytes))) {
    if (one.type == kLinkInfo) take_link_info(one.value, link);
    if (one.type == kMtu && one.value.size() == 4)
      link.carries_fd = get_u32(one.value, 0) >= kCanFdFrameBytes;
  }
  return link;
}

std::optional<Error> check_can_link(const CanLink& link, const std::string& name, int cycle_bits,
                                    double rate_Hz) {
  if (auto error = check_interface(link, name, CanFrame::kLinkType)) return error;
  if (link.bitrate && bus_time_s(cycle_bits, link.rate()) * rate_Hz > kMaxLoad) {
    return Error{
        fmt::format("{0} runs at {1} bit/s, too slow for three drives at {2} Hz: sudo ip "
                    "link set {0} down; sudo ip link set {0} up {3}, "
                    "and the drives alike, or lower rate_Hz",
                    name, *link.bitrate, rate_Hz, CanFrame::kLinkType)};
  }
  return std::nullopt;
}

std::optional<Error> check_can_link(const CanLink& link, const std::string& name,
                                    const CanFdBits& cycle, double rate_Hz) {
  if (auto error = check_interface(link, name, CanFdFrame::kLinkType)) return error;
  if (!link.carries_fd) {
    return Error{
        fmt::format("{0} carries classic CAN alone: sudo ip link set {0} down; sudo ip link set "
                    "{0} up {1}; if that is refused, take an adapter that has CAN FD",
                    name, CanFdFrame::kLinkType)};
  }
  if (link.has_controller && !link.fast_bitrate) {
    return Error{
        fmt::format("{0} has no fast bit rate: sudo ip link set {0} down; sudo ip link set {0} up "
                    "{1}",
                    name, CanFdFrame::kLinkType)};
  }
  if (!link.bitrate || !link.fast_bitrate) return std::nullopt;
  if (bus_time_s(cycle, link.rate()) * rate_Hz <= kMaxLoad) return std::nullopt;
  return Error{fmt::format(
      "{0} runs at {1} and {2} bit/s, too slow for three drives at {3} Hz: sudo ip link "
      "set {0} down; sudo ip link set {0} up {4}, and the drives alike, or lower rate_Hz",
      name, *link.bitrate, *link.fast_bitrate, rate_Hz, CanFdFrame::kLinkType)};
}

}  // namespace tact::hal::can
