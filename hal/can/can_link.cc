// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_link.h"

#include <fmt/core.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "hal/can/little_endian.h"

namespace tact::hal::can {
namespace {

using model::Error;
using model::Result;

constexpr std::size_t kHeader = 16, kLinkHeader = 16;
constexpr std::uint16_t kLinkInfo = 18, kInfoKind = 1, kInfoData = 2;
constexpr std::uint16_t kCanBitTiming = 1, kCanState = 4, kCanRestartMs = 6;
constexpr std::uint16_t kCanHardware = 280;  // ARPHRD_CAN
constexpr int kReplyTimeout_ms = 1000;
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
  if (kind != "can") return;  // others have other data
  for (const Attribute& one : parts)
    if (one.type == kInfoData) take_can_data(one.value, link);
}

Error refused(const std::string& name, const char* what, int error) {
  return Error{fmt::format("{}: {}: {}", name, what, std::strerror(error))};
}

// A bus on which frames are not sent, with its cure.
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

class File {
 public:
  explicit File(int fd) : fd_(fd) {}
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    if (fd_ >= 0) close(fd_);
  }
  int get() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

}  // namespace

std::optional<CanLink> decode_can_link(std::span<const std::uint8_t> message) {
  if (message.size() < kHeader + kLinkHeader) return std::nullopt;
  const std::size_t length = get_u32(message, 0);
  if (length < kHeader + kLinkHeader || length > message.size()) return std::nullopt;
  if (get_u16(message, 4) != RTM_NEWLINK) return std::nullopt;
  const auto body = message.subspan(kHeader, length - kHeader);
  CanLink link{.index = get_i32(body, 4),
               .is_can = get_u16(body, 2) == kCanHardware,
               .up = (get_u32(body, 8) & IFF_UP) != 0,
               .only_local = false,
               .bitrate = {},
               .state = {},
               .restart_ms = {}};
  for (const Attribute& one : attributes(body.subspan(kLinkHeader)))
    if (one.type == kLinkInfo) take_link_info(one.value, link);
  return link;
}

std::optional<Error> check_can_link(const CanLink& link, const std::string& name, int cycle_bits,
                                    double rate_Hz) {
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
  if (!link.up) {
    return Error{
        fmt::format("{0} is down: sudo ip link set {0} up type can bitrate 1000000", name)};
  }
  if (link.restart_ms.value_or(0) != 0) {
    return Error{
        fmt::format("{0} comes back by itself {1} ms after bus-off, into a force that is "
                    "old by then: sudo ip link set {0} down; sudo ip link set {0} up type "
                    "can bitrate 1000000 restart-ms 0",
                    name, *link.restart_ms)};
  }
  if (auto error = check_state(link, name)) return error;
  if (link.bitrate && cycle_bits * rate_Hz > kMaxLoad * *link.bitrate) {
    return Error{
        fmt::format("{0} runs at {1} bit/s, too slow for three drives at {2} Hz: sudo ip "
                    "link set {0} down; sudo ip link set {0} up type can bitrate 1000000, "
                    "and the drives alike, or lower rate_Hz",
                    name, *link.bitrate, rate_Hz)};
  }
  return std::nullopt;
}

Result<CanLink> read_can_link(const std::string& name) {
  if (name.empty() || name.size() >= IFNAMSIZ || if_nametoindex(name.c_str()) == 0) {
    return Error{
        fmt::format("there is no network interface \"{}\": is the CAN adapter plugged in? "
                    "ip link lists them, device.can.interface names one",
                    name)};
  }
  const File file(socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE));
  if (file.get() < 0) return refused(name, "no netlink socket", errno);
  const timeval patience{.tv_sec = kReplyTimeout_ms / 1000, .tv_usec = 0};
  setsockopt(file.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  std::array<std::uint8_t, kHeader + kLinkHeader> request{};
  put_unsigned(request, 0, 4, request.size());
  put_unsigned(request, 4, 2, RTM_GETLINK);
  put_unsigned(request, 6, 2, NLM_F_REQUEST);
  put_unsigned(request, kHeader + 4, 4, if_nametoindex(name.c_str()));
  if (send(file.get(), request.data(), request.size(), 0) < 0)
    return refused(name, "cannot ask for its state", errno);
  std::vector<std::uint8_t> reply(32768);
  const ssize_t n = recv(file.get(), reply.data(), reply.size(), 0);
  if (n < 0) return refused(name, "cannot read its state", errno);
  const auto link = decode_can_link(std::span(reply).first(static_cast<std::size_t>(n)));
  if (!link) return Error{fmt::format("{}: the kernel does not tell its state", name)};
  return *link;
}

Result<std::unique_ptr<CanSocket>> open_can_socket(const std::string& name, int index,
                                                   std::span<const std::uint32_t> ids) {
  File file(socket(AF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (file.get() < 0 && (errno == EPERM || errno == EACCES)) {
    return Error{
        fmt::format("{}: no permission for a CAN socket: tactd must not run in a container "
                    "or sandbox that forbids AF_CAN",
                    name)};
  }
  if (file.get() < 0) return refused(name, "this kernel has no CAN (sudo modprobe can_raw)", errno);
  std::vector<can_filter> filters;
  for (const std::uint32_t id : ids)  // exact: data frames of 11 bits, no requests
    filters.push_back({.can_id = id, .can_mask = CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG});
  const can_err_mask_t errors = CAN_ERR_MASK & ~CAN_ERR_LOSTARB;
  const int off = 0;
  const auto filter_bytes = static_cast<socklen_t>(filters.size() * sizeof(can_filter));
  const bool set =
      setsockopt(file.get(), SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), filter_bytes) == 0 &&
      setsockopt(file.get(), SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors) == 0 &&
      setsockopt(file.get(), SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &off, sizeof off) == 0 &&
      setsockopt(file.get(), SOL_CAN_RAW, CAN_RAW_LOOPBACK, &off, sizeof off) == 0;
  if (!set) return refused(name, "the kernel refuses the CAN filters", errno);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index;
  // NOLINTNEXTLINE: bind takes every family through this one type
  if (bind(file.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return refused(name, "cannot bind to it", errno);
  return std::make_unique<CanSocket>(file.release());
}

Result<std::unique_ptr<CanSocket>> open_checked_can(const std::string& name, int cycle_bits,
                                                    double rate_Hz,
                                                    std::span<const std::uint32_t> ids) {
  const auto link = read_can_link(name);
  if (!link) return link.error();
  if (auto error = check_can_link(*link, name, cycle_bits, rate_Hz)) return *error;
  return open_can_socket(name, link->index, ids);
}

}  // namespace tact::hal::can
