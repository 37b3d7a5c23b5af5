// SPDX-License-Identifier: Apache-2.0
// can_bus.h - one CAN bus in a tick: all received frames, one batch to send, and faults of the bus.
//
//     receive()  once per tick: one system call, at most 64 frames; error frames are evaluated here
//     push()     frames of this tick, in order of importance;   send()  one system call for all
//
// A batch that the kernel does not take whole (ENOBUFS, EAGAIN) is a missed cycle: counted, but not
// sent again, as its force would be old by then (CB-4); twenty in a row are a fault. Error passive,
// bus-off and a controller that restarted by itself latch kBusOff, an interface that was removed
// latches kBusDown, until the bus is opened again.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "hal/can/can_error.h"
#include "hal/can/can_frame.h"
#include "hal/can/can_socket.h"
#include "hal/device.h"
#include "hal/fault_latch.h"

namespace tact::hal::can {

using model::Fault;

template <class Frame>
struct BasicCanReceived {
  Frame frame;
  std::int64_t age_ns = 0;
};

struct CanBusCounts {
  std::uint64_t missed_cycles = 0;  // batches that were not sent whole
  std::uint64_t error_frames = 0;
  std::uint64_t unreadable = 0;  // neither data nor error frame of ours
};

/// A bus of classic frames or of CAN FD frames.
template <class Frame>
class BasicCanBus {
 public:
  using Received = BasicCanReceived<Frame>;
  using Bytes = typename Frame::Bytes;
  using Socket = BasicCanSocket<Bytes>;
  static constexpr int kMaxMissedInARow = 20;

  explicit BasicCanBus(std::unique_ptr<Socket> socket) : socket_(std::move(socket)) {}

  /// Data frames and requests since the last call, oldest first; valid until the next call.
  std::span<const Received> receive() RT_SAFE;
  /// The last receive() was full: newer frames may still wait.
  bool was_cut_short() const RT_SAFE { return was_cut_short_; }

  /// Adds a frame to the batch of this tick. No frame, or more than 16, makes it a missed cycle.
  void push(const std::optional<Frame>& frame) RT_SAFE;
  void send() RT_SAFE;
  /// Set-up: the pushed frames, which are then not sent; valid until the next push.
  std::span<const Bytes> take_batch();

  Fault fault() const RT_SAFE { return latch_.fault(); }
  FaultCause cause() const RT_SAFE { return latch_.cause(); }
  const CanBusCounts& counts() const RT_SAFE { return counts_; }
  /// All error frames so far: why no drive answers at start.
  const CanError& errors_seen() const RT_SAFE { return errors_seen_; }
  Socket& socket() { return *socket_; }
  const CanRate& rate() const { return socket_->rate(); }

 private:
  void evaluate(const CanError& error) RT_SAFE;
  void miss() RT_SAFE;

  std::unique_ptr<Socket> socket_;
  std::array<BasicCanArrival<Bytes>, Socket::kMaxReceived> arrivals_{};
  std::array<Received, Socket::kMaxReceived> received_{};
  std::array<Bytes, Socket::kMaxSent> batch_{};
  std::size_t batched_ = 0;
  bool batch_whole_ = true;
  bool was_cut_short_ = false;
  int missed_in_a_row_ = 0;
  CanError errors_seen_;
  CanBusCounts counts_;
  FaultLatch latch_;
};

using CanReceived = BasicCanReceived<CanFrame>;
using CanBus = BasicCanBus<CanFrame>;
using CanFdReceived = BasicCanReceived<CanFdFrame>;
using CanFdBus = BasicCanBus<CanFdFrame>;

/// What a cause of the bus means, with the remedy; empty for causes that are not the bus's.
std::string can_bus_fault_detail(const FaultCause& cause, const std::string& interface,
                                 const char* link_type = CanFrame::kLinkType);

/// Set-up: why no drive was heard at all, as far as the bus itself says.
template <class Frame>
std::string silent_bus_detail(const BasicCanBus<Frame>& bus, const std::string& interface);

}  // namespace tact::hal::can
