// SPDX-License-Identifier: Apache-2.0
// can_socket.h - the kernel's side of a CAN bus: many frames in one call each way, none ever waits.
//
// Any socket whose datagrams are the 16 bytes of `struct can_frame` (can_frame.h), or on a CAN FD
// bus the 72 of `struct canfd_frame` (can_fd_frame.h): SocketCAN's raw sockets, and a socketpair
// for tests. Buffers belong to the object and are set up once. The age of a frame is the time since
// the kernel stamped it (SO_TIMESTAMPNS), as a difference of the same clock, so the clocks of
// kernel and loop never mix; what a step of the wall clock does to it is in stamp_age.h. Without a
// stamp the age is 0.
#pragma once

#include <sys/socket.h>
#include <sys/syscall.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/can/can_fd_frame.h"
#include "hal/can/can_frame.h"
#include "hal/can/stamp_age.h"

namespace tact::hal::can {

template <class Bytes>
struct BasicCanArrival {
  Bytes bytes{};
  std::int64_t age_ns = 0;
};

template <class Bytes>
class BasicCanSocket {
 public:
  using Arrival = BasicCanArrival<Bytes>;

  static constexpr std::size_t kMaxReceived = 64, kMaxSent = 16;  // in one call
  static constexpr std::array kLoopCalls{SYS_recvmmsg, SYS_sendmmsg};

  /// Takes the file over and asks it for time stamps. `rate`: of the bus behind it.
  explicit BasicCanSocket(int fd, const CanRate& rate = {});
  BasicCanSocket(const BasicCanSocket&) = delete;
  BasicCanSocket& operator=(const BasicCanSocket&) = delete;
  virtual ~BasicCanSocket();

  /// recvmmsg: how many frames, oldest first; 0 for none; -errno. Datagrams of another length come
  /// as zeroes, which are no frame of ours; a classic frame on a CAN FD bus has zeroes behind it.
  virtual int receive(std::span<Arrival> out) RT_SAFE;
  /// sendmmsg: how many frames the kernel took; -errno if none.
  virtual int send(std::span<const Bytes> frames) RT_SAFE;

  /// Set-up only: until a frame is there, or this long.
  virtual void wait(int timeout_ms);
  /// Set-up only: CLOCK_MONOTONIC.
  virtual std::int64_t now_ns();

  /// Open as long as this object.
  int fd() const RT_SAFE { return fd_; }
  const CanRate& rate() const { return rate_; }

 private:
  std::int64_t age_ns(const msghdr& message) const RT_SAFE;

  struct alignas(alignof(cmsghdr)) Control {
    std::array<std::uint8_t, 64> bytes;
  };
  int fd_;
  CanRate rate_;
  StampAge stamps_;
  std::array<mmsghdr, kMaxReceived> in_{};
  std::array<iovec, kMaxReceived> in_place_{};
  std::array<Bytes, kMaxReceived> in_bytes_{};
  std::array<Control, kMaxReceived> in_control_{};
  std::array<mmsghdr, kMaxSent> out_{};
  std::array<iovec, kMaxSent> out_place_{};
  std::array<Bytes, kMaxSent> out_bytes_{};
};

using CanArrival = BasicCanArrival<CanFrameBytes>;
using CanSocket = BasicCanSocket<CanFrameBytes>;
using CanFdArrival = BasicCanArrival<CanFdFrameBytes>;
using CanFdSocket = BasicCanSocket<CanFdFrameBytes>;

}  // namespace tact::hal::can
