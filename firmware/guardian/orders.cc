// SPDX-License-Identifier: Apache-2.0
#include "firmware/guardian/orders.h"

#include <sys/socket.h>

#include <array>
#include <cstring>

namespace tact::firmware::guardian {
namespace {

constexpr std::size_t kFds = 2;  // liveness lock, device

/// Orders and a buffer for two descriptors, as sendmsg and recvmsg take them.
class Message {
 public:
  explicit Message(Orders& orders) : place_{.iov_base = &orders, .iov_len = sizeof orders} {
    header_.msg_iov = &place_;
    header_.msg_iovlen = 1;
    header_.msg_control = control_.data();
    header_.msg_controllen = control_.size();
  }
  Message(const Message&) = delete;
  Message& operator=(const Message&) = delete;
  msghdr* header() { return &header_; }
  cmsghdr* descriptors() { return CMSG_FIRSTHDR(&header_); }

 private:
  iovec place_;
  alignas(cmsghdr) std::array<std::uint8_t, CMSG_SPACE(kFds * sizeof(int))> control_{};
  msghdr header_{};
};

}  // namespace

bool give_orders(int socket, const Orders& orders, int liveness_fd) {
  // msghdr takes no pointer to const.
  Orders copy = orders;
  Message message(copy);
  cmsghdr* header = message.descriptors();
  header->cmsg_level = SOL_SOCKET;
  header->cmsg_type = SCM_RIGHTS;
  header->cmsg_len = CMSG_LEN(kFds * sizeof(int));
  const std::array<int, kFds> fds{liveness_fd, orders.frames.fd};
  std::memcpy(CMSG_DATA(header), fds.data(), sizeof fds);
  return sendmsg(socket, message.header(), MSG_NOSIGNAL) == static_cast<ssize_t>(sizeof copy);
}

std::optional<TakenOrders> take_orders(int socket) {
  TakenOrders taken;
  Message message(taken.orders);
  const ssize_t size = recvmsg(socket, message.header(), MSG_CMSG_CLOEXEC);
  const cmsghdr* header = size > 0 ? message.descriptors() : nullptr;
  // A datagram of another length, or without both descriptors, comes from another build or sender.
  const bool whole = size == static_cast<ssize_t>(sizeof taken.orders) &&
                     taken.orders.magic == Orders{}.magic && header != nullptr &&
                     header->cmsg_type == SCM_RIGHTS &&
                     header->cmsg_len == CMSG_LEN(kFds * sizeof(int));
  if (!whole) return std::nullopt;
  std::array<int, kFds> fds{};
  std::memcpy(fds.data(), CMSG_DATA(header), sizeof fds);
  taken.liveness_fd = fds[0];
  // The fd number inside the datagram is valid in tactd only; the received descriptor replaces it.
  taken.orders.frames.fd = fds[1];
  return taken;
}

}  // namespace tact::firmware::guardian
