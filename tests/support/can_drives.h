// SPDX-License-Identifier: Apache-2.0
// can_drives.h - a CAN bus of one socketpair for tests: the host's socket, and who plays the
// drives.
//
// Time is made, not measured: every wait of the host lets one millisecond pass for the drives, and
// every frame has the age that the test says. So bring-up with its seconds takes no time, and the
// same test gives the same run.
#pragma once

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "hal/can/can_bus.h"

namespace tact::tests {

/// The host's end, with misfortunes.
template <class Frame>
class BasicScriptedSocket final : public hal::can::BasicCanSocket<typename Frame::Bytes> {
 public:
  using Bytes = typename Frame::Bytes;
  using Base = hal::can::BasicCanSocket<Bytes>;

  BasicScriptedSocket(int fd, const hal::can::CanRate& rate, std::function<void()> millisecond)
      : Base(fd, rate), millisecond_(std::move(millisecond)) {}

  int receive(std::span<hal::can::BasicCanArrival<Bytes>> out) RT_SAFE override {
    ++calls;
    if (receive_error != 0) return -receive_error;
    const int n = Base::receive(out);
    for (int i = 0; i < n; ++i) out[static_cast<std::size_t>(i)].age_ns = age_ns;
    return n;
  }
  int send(std::span<const Bytes> frames) RT_SAFE override {
    ++calls;
    if (send_error != 0) return -send_error;
    return Base::send(frames);
  }
  void wait(int timeout_ms) override {
    (void)timeout_ms;
    now += 1'000'000;
    millisecond_();
  }
  std::int64_t now_ns() override { return now; }

  std::int64_t now = 1'000'000'000;
  std::int64_t age_ns = 100'000;
  int calls = 0;
  int send_error = 0, receive_error = 0;

 private:
  std::function<void()> millisecond_;
};

/// Both ends; what the host sends is read by listen(), what drives say goes through say().
template <class Frame>
class BasicScriptedBus {
 public:
  using Bytes = typename Frame::Bytes;
  using Socket = BasicScriptedSocket<Frame>;
  using Bus = hal::can::BasicCanBus<Frame>;

  explicit BasicScriptedBus(std::function<void()> millisecond)
      : millisecond_(std::move(millisecond)) {
    connect();
  }
  BasicScriptedBus(const BasicScriptedBus&) = delete;
  BasicScriptedBus& operator=(const BasicScriptedBus&) = delete;
  ~BasicScriptedBus() { unplug(); }

  /// A new pair of ends, as for a host that was started again, or a bus at another rate.
  void connect(const hal::can::CanRate& rate = {}) {
    unplug();
    int fds[2] = {-1, -1};
    if (socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, fds) != 0) std::abort();
    drives_fd_ = fds[1];
    auto socket = std::make_unique<Socket>(fds[0], rate, millisecond_);
    socket_ = socket.get();
    bus_ = std::make_unique<Bus>(std::move(socket));
  }
  /// The drives' end for another owner, which closes it.
  int give_drives_end() { return std::exchange(drives_fd_, -1); }

  /// To give to the device; the socket lives with it.
  std::unique_ptr<Bus> bus() { return std::move(bus_); }
  Socket& socket() { return *socket_; }

  void say(const Frame& frame) {
    if (const auto bytes = hal::can::pack_can_frame(frame)) say_bytes(*bytes);
  }
  void say_bytes(std::span<const std::uint8_t> bytes) {
    [[maybe_unused]] const auto n = ::send(drives_fd_, bytes.data(), bytes.size(), MSG_DONTWAIT);
  }
  void say_error(std::uint32_t classes, std::uint8_t controller) {
    hal::can::CanFrameBytes bytes{};
    const std::uint32_t id = classes | 1u << 29;
    for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(id >> (8 * i));
    bytes[4] = 8;
    bytes[9] = controller;
    say_bytes(bytes);
  }
  std::optional<Frame> hear() {
    Bytes bytes{};
    const auto n = ::recv(drives_fd_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (n != static_cast<ssize_t>(bytes.size())) return std::nullopt;
    if constexpr (std::is_same_v<Frame, hal::can::CanFrame>)
      return hal::can::unpack_can_frame(bytes);
    else
      return hal::can::unpack_can_fd_frame(bytes);
  }
  /// All that the host sent since the last call.
  std::vector<Frame> hear_all() {
    std::vector<Frame> frames;
    while (auto frame = hear()) frames.push_back(*frame);
    return frames;
  }
  void unplug() {
    if (drives_fd_ >= 0) close(drives_fd_);
    drives_fd_ = -1;
  }

 private:
  std::function<void()> millisecond_;
  int drives_fd_ = -1;
  std::unique_ptr<Bus> bus_;
  Socket* socket_ = nullptr;
};

using ScriptedSocket = BasicScriptedSocket<hal::can::CanFrame>;
using ScriptedBus = BasicScriptedBus<hal::can::CanFrame>;
using ScriptedFdBus = BasicScriptedBus<hal::can::CanFdFrame>;

}  // namespace tact::tests
