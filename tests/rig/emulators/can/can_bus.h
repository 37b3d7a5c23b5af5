// SPDX-License-Identifier: Apache-2.0
// can_bus.h - the emulated drives' end of the CAN cable, which can spoil what they say.
//
// A raw SocketCAN socket (Linux, Documentation/networking/can.rst). A classic frame is the first 16
// bytes of a canfd_frame, so one type holds both; which one goes out is said by `with_fd`. Faults
// of a FaultPlan act here on what leaves; error frames are sent as ordinary frames with the error
// flag, as linux/can/error.h has them, and reach every socket that asks for errors.
#pragma once

#include <linux/can.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "tests/rig/emulators/run/fault_plan.h"

namespace tact::rig {

enum class CanRole : std::uint8_t { kSample, kHeartbeat, kOther };

class CanBus {
 public:
  /// `node_step`: how much one node number more changes an identifier.
  CanBus(FaultPlan& faults, std::uint32_t node_step, bool with_fd = false)
      : faults_(faults), node_step_(node_step), with_fd_(with_fd) {}
  CanBus(const CanBus&) = delete;
  CanBus& operator=(const CanBus&) = delete;
  ~CanBus();

  /// False: the message with the remedy.
  bool open(const std::string& interface, std::string& error);
  /// Any end of a packet socket in place of an interface; it is closed with the bus.
  void adopt(int descriptor) { fd_ = descriptor; }
  int descriptor() const { return fd_; }
  /// The next frame; without blocking.
  std::optional<canfd_frame> receive();
  /// What drive `axis` says; dropped when the queue is full or the link is down.
  void send(int axis, CanRole role, std::uint32_t id, std::span<const std::uint8_t> payload,
            std::int64_t now_ns);
  /// Error frames that are due.
  void tick(std::int64_t now_ns);

 private:
  void write(const void* frame, std::size_t size);
  void write(const canfd_frame& frame);
  void send_sample(std::size_t axis, canfd_frame frame, std::int64_t now_ns);

  FaultPlan& faults_;
  std::uint32_t node_step_;
  bool with_fd_;
  int fd_ = -1;
  std::array<std::optional<canfd_frame>, 3> held_{}, stale_{};
  std::uint32_t noise_ = 1;
};

}  // namespace tact::rig
