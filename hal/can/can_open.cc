// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_open.h"

#include <fmt/core.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "hal/can/little_endian.h"
#include "hal/device_lock.h"

namespace tact::hal::can {
namespace {

using model::Error;
using model::Result;

constexpr int kReplyTimeout_ms = 1000;

Error refused(const std::string& name, const char* what, int error, const char* remedy) {
  return Error{fmt::format("{}: {} ({}): {}", name, what, std::strerror(error), remedy)};
}
constexpr const char* kLookAtLink = "the link may have gone; ip -details link shows it";
constexpr const char* kNewerKernel =
    "a kernel of Debian 12 or 13 takes them; uname -r prints the running one";

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

/// A bound socket with these filters.
Result<int> open_socket(const std::string& name, int index, std::span<const can_filter> filters,
                        bool fd_frames) {
  File file(socket(AF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (file.get() < 0 && (errno == EPERM || errno == EACCES)) {
    return Error{
        fmt::format("{}: no permission for a CAN socket: tactd must not run in a container "
                    "or sandbox that forbids AF_CAN",
                    name)};
  }
  if (file.get() < 0)
    return refused(name, "this kernel has no CAN", errno, "sudo modprobe can_raw");
  const can_err_mask_t errors = CAN_ERR_MASK & ~CAN_ERR_LOSTARB;
  const int off = 0, on = 1;
  const auto filter_bytes = static_cast<socklen_t>(filters.size_bytes());
  const bool set =
      setsockopt(file.get(), SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), filter_bytes) == 0 &&
      setsockopt(file.get(), SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors) == 0 &&
      setsockopt(file.get(), SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &off, sizeof off) == 0 &&
      setsockopt(file.get(), SOL_CAN_RAW, CAN_RAW_LOOPBACK, &off, sizeof off) == 0;
  if (!set) return refused(name, "the kernel refuses the CAN filters", errno, kNewerKernel);
  if (fd_frames && setsockopt(file.get(), SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on) != 0)
    return refused(name, "the kernel refuses CAN FD", errno, kNewerKernel);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index;
  // bind takes every family through this one type
  if (bind(file.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return refused(name, "cannot bind to it", errno, kLookAtLink);
  return file.release();
}

template <class Bytes, class Bits>
Result<std::unique_ptr<BasicCanSocket<Bytes>>> open_checked(const std::string& name,
                                                            const Bits& cycle, double rate_Hz,
                                                            std::span<const can_filter> filters) {
  const auto link = read_can_link(name);
  if (!link) return link.error();
  if (const auto refusal = check_can_link(*link, name, cycle, rate_Hz)) return refusal->error(": ");
  const auto fd = open_socket(name, link->index, filters, sizeof(Bytes) == kCanFdFrameBytes);
  if (!fd) return fd.error();
  return std::make_unique<BasicCanSocket<Bytes>>(*fd, link->rate());
}

}  // namespace

Result<CanLink> read_can_link(const std::string& name) {
  if (name.empty() || name.size() >= IFNAMSIZ || if_nametoindex(name.c_str()) == 0) {
    return Error{
        fmt::format("there is no network interface \"{}\": is the CAN adapter plugged in? "
                    "ip link lists them, device.can.interface names one",
                    name)};
  }
  const File file(socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE));
  if (file.get() < 0) {
    return refused(name, "no netlink socket", errno,
                   "a unit or sandbox around tactd must allow AF_NETLINK, as tactd@.service does");
  };
  const timeval timeout{.tv_sec = kReplyTimeout_ms / 1000, .tv_usec = 0};
  setsockopt(file.get(), SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
  std::array<std::uint8_t, kNetlinkHeader_bytes + kNetlinkLinkHeader_bytes> request{};
  put_unsigned(request, 0, 4, request.size());
  put_unsigned(request, 4, 2, RTM_GETLINK);
  put_unsigned(request, 6, 2, NLM_F_REQUEST);
  put_unsigned(request, kNetlinkHeader_bytes + 4, 4, if_nametoindex(name.c_str()));
  if (send(file.get(), request.data(), request.size(), 0) < 0)
    return refused(name, "cannot ask for its state", errno, kLookAtLink);
  std::vector<std::uint8_t> reply(32768);
  const ssize_t n = recv(file.get(), reply.data(), reply.size(), 0);
  if (n < 0) return refused(name, "cannot read its state", errno, kLookAtLink);
  const auto link = decode_can_link(std::span(reply).first(static_cast<std::size_t>(n)));
  if (!link)
    return Error{fmt::format("{}: the kernel does not report its state: {}", name, kLookAtLink)};
  return *link;
}

Result<std::unique_ptr<CanSocket>> open_checked_can(const std::string& name, int cycle_bits,
                                                    double rate_Hz,
                                                    std::span<const std::uint32_t> ids) {
  std::vector<can_filter> filters;
  for (const std::uint32_t id : ids)  // exact: data frames of 11 bits, no requests
    filters.push_back({.can_id = id, .can_mask = CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG});
  return open_checked<CanFrameBytes>(name, cycle_bits, rate_Hz, filters);
}

Result<std::unique_ptr<CanFdSocket>> open_checked_can(const std::string& name,
                                                      const CanFdBits& cycle, double rate_Hz,
                                                      std::span<const std::uint32_t> ids,
                                                      std::span<const int> nodes) {
  std::vector<can_filter> filters;
  for (const std::uint32_t id : ids) {  // exact
    constexpr canid_t kAll = CAN_EFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG;
    filters.push_back({.can_id = id | CAN_EFF_FLAG, .can_mask = kAll});
    if (id <= CAN_SFF_MASK) filters.push_back({.can_id = id, .can_mask = kAll});
  }
  for (const int node : nodes)
    filters.push_back({.can_id = static_cast<canid_t>(node), .can_mask = 0x7F | CAN_RTR_FLAG});
  return open_checked<CanFdFrameBytes>(name, cycle, rate_Hz, filters);
}

std::optional<Error> lock_drives(const CanSettings& settings, bool gives_sync) {
  std::array<char, IF_NAMESIZE> name{};  // its own: an interface may have other names beside it
  const unsigned index = if_nametoindex(settings.interface.c_str());
  if (index == 0 || if_indextoname(index, name.data()) == nullptr) return std::nullopt;
  for (const int node : settings.node)
    if (auto error = lock_device(fmt::format("{}, node {}", name.data(), node))) return error;
  return gives_sync ? lock_device(fmt::format("the SYNC of {}", name.data())) : std::nullopt;
}

}  // namespace tact::hal::can
