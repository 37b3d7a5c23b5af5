// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/can/can_bus.h"

#include <fcntl.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace tact::rig {
namespace {

constexpr std::uint32_t kStranger = 0x10;  // added to a node's number: of no node

can_frame error_frame(FaultKind kind) {
  can_frame frame{};
  frame.can_id = CAN_ERR_FLAG;
  frame.can_dlc = CAN_ERR_DLC;
  if (kind == FaultKind::kBusOffFrame) frame.can_id |= CAN_ERR_BUSOFF;
  if (kind == FaultKind::kNoAckFrame) frame.can_id |= CAN_ERR_ACK;
  if (kind == FaultKind::kErrorPassiveFrame) {
    frame.can_id |= CAN_ERR_CRTL;
    frame.data[1] = CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE;
  }
  return frame;
}

}  // namespace

CanBus::~CanBus() {
  if (fd_ >= 0) close(fd_);
}

bool CanBus::open(const std::string& interface, std::string& error) {
  fd_ = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (fd_ < 0) {
    error = std::string("this kernel has no CAN sockets (") + std::strerror(errno) +
            "): modprobe can_raw";
    return false;
  }
  const int on = 1;
  if (with_fd_ && setsockopt(fd_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on) != 0) {
    error = std::string("this kernel has no CAN FD (") + std::strerror(errno) + ")";
    return false;
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  if (address.can_ifindex == 0) {
    error =
        "no CAN interface " + interface + ": ip link add can0 type vxcan peer name " + interface;
    return false;
  }
  if (bind(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    error = interface + " cannot be bound (" + std::strerror(errno) + ")";
    return false;
  }
  return true;
}

std::optional<canfd_frame> CanBus::receive() {
  canfd_frame frame{};
  const ssize_t size = read(fd_, &frame, with_fd_ ? CANFD_MTU : CAN_MTU);
  if (size != static_cast<ssize_t>(CAN_MTU) && size != static_cast<ssize_t>(CANFD_MTU))
    return std::nullopt;
  if ((frame.can_id & (CAN_ERR_FLAG | (with_fd_ ? 0u : CAN_EFF_FLAG))) != 0) return std::nullopt;
  return frame;
}

void CanBus::write(const void* frame, std::size_t size) {
  // A full queue or a downed link loses the frame, as it would on the wire.
  [[maybe_unused]] const ssize_t written = ::write(fd_, frame, size);
}

void CanBus::write(const canfd_frame& frame) {
  canfd_frame out = frame;
  if (!with_fd_) return write(&out, CAN_MTU);
  out.flags = CANFD_BRS | CANFD_FDF;
  if (out.can_id > CAN_SFF_MASK) out.can_id |= CAN_EFF_FLAG;
  write(&out, CANFD_MTU);
}

void CanBus::send(int axis, CanRole role, std::uint32_t id, std::span<const std::uint8_t> payload,
                  std::int64_t now_ns) {
  if (faults_.active(FaultKind::kSilent, axis, now_ns) ||
      (role == CanRole::kHeartbeat && faults_.active(FaultKind::kHeartbeatMissing, axis, now_ns)))
    return;
  canfd_frame frame{};
  frame.can_id = id;
  frame.len = static_cast<std::uint8_t>(
      std::min<std::size_t>(payload.size(), with_fd_ ? CANFD_MAX_DLEN : CAN_MAX_DLEN));
  std::copy_n(payload.begin(), frame.len, std::begin(frame.data));
  if (role == CanRole::kSample)
    send_sample(static_cast<std::size_t>(axis), frame, now_ns);
  else
    write(frame);
}

void CanBus::send_sample(std::size_t axis, canfd_frame frame, std::int64_t now_ns) {
  const int number = static_cast<int>(axis);
  const auto acts = [&](FaultKind kind) { return faults_.active(kind, number, now_ns); };
  if (!acts(FaultKind::kStale))
    stale_[axis] = frame;
  else if (stale_[axis])
    frame = *stale_[axis];
  if (acts(FaultKind::kLost)) return;
  if (acts(FaultKind::kGarbage)) {
    for (std::uint8_t& byte : std::span(frame.data).first(with_fd_ ? frame.len : CAN_MAX_DLEN)) {
      noise_ = noise_ * 1664525u + 1013904223u;  // Numerical Recipes' generator
      byte = static_cast<std::uint8_t>(noise_ >> 24u);
    }
    if (!with_fd_) {
      frame.len = static_cast<std::uint8_t>(noise_ >> 8u & 8u) != 0
                      ? std::uint8_t{CAN_MAX_DLEN}
                      : static_cast<std::uint8_t>(noise_ >> 12u & 7u);
    }
  }
  if (acts(FaultKind::kWrongNode)) frame.can_id ^= kStranger * node_step_;
  if (acts(FaultKind::kReordered) && !held_[axis]) {
    held_[axis] = frame;
    return;
  }
  write(frame);
  if (acts(FaultKind::kDuplicated)) write(frame);
  if (held_[axis]) write(*held_[axis]);
  held_[axis].reset();
}

void CanBus::tick(std::int64_t now_ns) {
  for (const FaultKind kind :
       {FaultKind::kBusOffFrame, FaultKind::kErrorPassiveFrame, FaultKind::kNoAckFrame}) {
    if (!faults_.once(kind, -1, now_ns)) continue;
    const can_frame frame = error_frame(kind);
    write(&frame, sizeof frame);
  }
}

}  // namespace tact::rig
