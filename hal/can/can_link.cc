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

constexpr std::uint16_t kLinkInfo = 18, kInfoKind = 1, kInfoData = 2;
constexpr std::uint16_t kMtu = 4;
constexpr std::uint16_t kCanBitTiming = 1, kCanState = 4, kCanRestartMs = 6, kCanFastTiming = 9;
constexpr std::uint16_t kCanHardware = 280;  // ARPHRD_CAN
constexpr double kMaxLoad_ratio = 0.95;

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

/// The command that sets a bus up again; `how` are its parameters.
std::string again(const std::string& name, const std::string& how = {}) {
  return fmt::format("sudo ip link set {0} down; sudo ip link set {0} up{1}{2}", name,
                     how.empty() ? "" : " ", how);
}

// A bus on which frames are not sent, with its remedy.
std::optional<Refusal> check_state(const CanLink& link, const std::string& name) {
  if (link.state == CanLinkState::kBusOff)
    return Refusal{name + " is bus-off",
                   "check bit rate, termination and cable; then " + again(name)};
  if (link.state == CanLinkState::kPassive)
    return Refusal{
        name + " is error passive",
        "is it at the drives' bit rate, are they powered and both ends terminated? Then " +
            again(name)};
  if (link.state == CanLinkState::kStopped || link.state == CanLinkState::kSleeping)
    return Refusal{name + " sleeps", again(name)};
  return std::nullopt;
}

// What every bus needs; `link_type` sets it up.
std::optional<Refusal> check_interface(const CanLink& link, const std::string& name,
                                       const char* link_type) {
  if (!link.is_can)
    return Refusal{name + " is no CAN interface",
                   "set device.can.interface to one (ip -details link shows them)"};
  if (link.only_local)
    return Refusal{
        name + " is a vcan, which carries nothing between programs that do not ask for loopback",
        "use a pair, sudo ip link add can0 type vxcan peer name can1"};
  if (!link.up)
    return Refusal{name + " is down", fmt::format("sudo ip link set {} up {}", name, link_type)};
  if (link.restart_ms.value_or(0) != 0)
    return Refusal{fmt::format("{} comes back by itself {} ms after bus-off, into a force that is "
                               "old by then",
                               name, *link.restart_ms),
                   again(name, link_type) + " restart-ms 0"};
  // A serial adapter (slcan) that its daemon has set up reports none.
  if (link.has_controller && !link.bitrate)
    return Refusal{name + " does not report its bit rate, so the delay of a force is unknown",
                   again(name, link_type)};
  return check_state(link, name);
}

Refusal too_slow(const std::string& name, const std::string& rates, double rate_Hz,
                 const char* link_type) {
  return {
      fmt::format("{} runs at {} bit/s, too slow for three drives at {} Hz", name, rates, rate_Hz),
      again(name, link_type) + ", and the drives alike, or lower rate_Hz"};
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

std::optional<Refusal> check_can_link(const CanLink& link, const std::string& name, int cycle_bits,
                                      double rate_Hz) {
  if (auto refusal = check_interface(link, name, CanFrame::kLinkType)) return refusal;
  if (link.bitrate && bus_time_s(cycle_bits, link.rate()) * rate_Hz > kMaxLoad_ratio)
    return too_slow(name, std::to_string(*link.bitrate), rate_Hz, CanFrame::kLinkType);
  return std::nullopt;
}

std::optional<Refusal> check_can_link(const CanLink& link, const std::string& name,
                                      const CanFdBits& cycle, double rate_Hz) {
  if (auto refusal = check_interface(link, name, CanFdFrame::kLinkType)) return refusal;
  const std::string command = again(name, CanFdFrame::kLinkType);
  if (!link.carries_fd)
    return Refusal{name + " carries classic CAN alone",
                   command + "; if that is refused, take an adapter that has CAN FD"};
  if (link.has_controller && !link.fast_bitrate)
    return Refusal{name + " has no fast bit rate", command};
  if (!link.bitrate || !link.fast_bitrate) return std::nullopt;
  if (bus_time_s(cycle, link.rate()) * rate_Hz <= kMaxLoad_ratio) return std::nullopt;
  return too_slow(name, fmt::format("{} and {}", *link.bitrate, *link.fast_bitrate), rate_Hz,
                  CanFdFrame::kLinkType);
}

}  // namespace tact::hal::can
