// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_socket.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "hal/monotonic.h"
#include "model/time_ns.h"

#if defined(__has_feature)
#if __has_feature(realtime_sanitizer)
#include <sanitizer/rtsan_interface.h>
#define TACT_THIS_CALL_NEVER_WAITS const __rtsan::ScopedDisabler never_waits
#endif
#endif
#ifndef TACT_THIS_CALL_NEVER_WAITS
#define TACT_THIS_CALL_NEVER_WAITS static_cast<void>(0)
#endif

namespace tact::hal::can {
namespace {

std::int64_t in_ns(const timespec& t) RT_SAFE { return t.tv_sec * model::kSecond_ns + t.tv_nsec; }

// The only calls that a tick makes: neither the compiler nor the real-time sanitizer can see that
// they do not wait.
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wfunction-effects"
#endif
int receive_batch(int fd, std::span<mmsghdr> messages) RT_SAFE {
  TACT_THIS_CALL_NEVER_WAITS;
  const int n =
      recvmmsg(fd, messages.data(), static_cast<unsigned>(messages.size()), MSG_DONTWAIT, nullptr);
  return n < 0 ? -errno : n;
}
int send_batch(int fd, std::span<mmsghdr> messages) RT_SAFE {
  TACT_THIS_CALL_NEVER_WAITS;
  const int n = sendmmsg(fd, messages.data(), static_cast<unsigned>(messages.size()),
                         MSG_DONTWAIT | MSG_NOSIGNAL);
  return n < 0 ? -errno : n;
}
timespec wall_clock() RT_SAFE {  // the clock of the kernel's stamps; answered without the kernel
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return now;
}
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic pop
#endif

}  // namespace

template <class Bytes>
BasicCanSocket<Bytes>::BasicCanSocket(int fd, const CanRate& rate) : fd_(fd), rate_(rate) {
  const int on = 1;
  setsockopt(fd_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  for (std::size_t i = 0; i < kMaxReceived; ++i) {
    in_place_[i] = {.iov_base = in_bytes_[i].data(), .iov_len = sizeof(Bytes)};
    in_[i].msg_hdr.msg_iov = &in_place_[i];
    in_[i].msg_hdr.msg_iovlen = 1;
    in_[i].msg_hdr.msg_control = in_control_[i].bytes.data();
  }
  for (std::size_t i = 0; i < kMaxSent; ++i) {
    out_place_[i] = {.iov_base = out_bytes_[i].data(), .iov_len = sizeof(Bytes)};
    out_[i].msg_hdr.msg_iov = &out_place_[i];
    out_[i].msg_hdr.msg_iovlen = 1;
  }
}

template <class Bytes>
BasicCanSocket<Bytes>::~BasicCanSocket() {
  close(fd_);
}

template <class Bytes>
int BasicCanSocket<Bytes>::receive(std::span<Arrival> out) RT_SAFE {
  const std::size_t most = std::min(out.size(), kMaxReceived);
  for (std::size_t i = 0; i < most; ++i)              // bound: most (kMaxReceived)
    in_[i].msg_hdr.msg_controllen = sizeof(Control);  // the kernel wrote what it used
  const int reported = receive_batch(fd_, std::span(in_).first(most));
  const int n = reported == -EAGAIN || reported == -EINTR ? 0 : reported;
  if (n < 0) return n;
  const bool empties = static_cast<std::size_t>(n) < most && reported != -EINTR;
  stamps_.look(in_ns(wall_clock()), monotonic_ns(), empties);
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {  // bound: n (kMaxReceived)
    const bool whole = in_[i].msg_len == sizeof(Bytes);
    out[i] = {.bytes = whole ? in_bytes_[i] : Bytes{}, .age_ns = age_ns(in_[i].msg_hdr)};
    if constexpr (sizeof(Bytes) > kCanFrameBytes) {  // an error frame comes as a classic one
      if (in_[i].msg_len == kCanFrameBytes)
        std::copy_n(in_bytes_[i].begin(), kCanFrameBytes, out[i].bytes.begin());
    }
  }
  return n;
}

template <class Bytes>
std::int64_t BasicCanSocket<Bytes>::age_ns(const msghdr& message) const RT_SAFE {
  const auto* header = static_cast<const cmsghdr*>(message.msg_control);
  const bool stamped = message.msg_controllen >= CMSG_LEN(sizeof(timespec)) &&
                       header->cmsg_level == SOL_SOCKET && header->cmsg_type == SCM_TIMESTAMPNS;
  if (!stamped) return 0;
  timespec stamp{};
  std::memcpy(&stamp, CMSG_DATA(header), sizeof stamp);
  return stamps_.of(in_ns(stamp));
}

template <class Bytes>
int BasicCanSocket<Bytes>::send(std::span<const Bytes> frames) RT_SAFE {
  const std::size_t n = std::min(frames.size(), kMaxSent);
  if (n == 0) return 0;
  std::copy_n(frames.begin(), n, out_bytes_.begin());
  return send_batch(fd_, std::span(out_).first(n));
}

template <class Bytes>
void BasicCanSocket<Bytes>::wait(int timeout_ms) {
  pollfd one{.fd = fd_, .events = POLLIN, .revents = 0};
  poll(&one, 1, timeout_ms);
}

template <class Bytes>
std::int64_t BasicCanSocket<Bytes>::now_ns() {
  return monotonic_ns();
}

template class BasicCanSocket<CanFrameBytes>;
template class BasicCanSocket<CanFdFrameBytes>;

}  // namespace tact::hal::can
