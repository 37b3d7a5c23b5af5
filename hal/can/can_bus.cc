// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_bus.h"

#include <fmt/core.h>

#include <cerrno>
#include <cstring>

namespace tact::hal::can {
namespace {

constexpr std::uint8_t kind_of(CanCause cause) { return static_cast<std::uint8_t>(cause); }

/// Full now, perhaps not in the next tick. Everything else does not repair itself.
bool is_no_room(int error) RT_SAFE {
  return error == ENOBUFS || error == EAGAIN || error == EINTR || error == ENOMEM;
}

std::optional<CanFrame> unpack(const CanFrameBytes& bytes) RT_SAFE {
  return unpack_can_frame(bytes);
}
std::optional<CanFdFrame> unpack(const CanFdFrameBytes& bytes) RT_SAFE {
  return unpack_can_fd_frame(bytes);
}

}  // namespace

template <class Frame>
auto BasicCanBus<Frame>::receive() RT_SAFE -> std::span<const Received> {
  const int n = socket_->receive(arrivals_);
  was_cut_short_ = n == static_cast<int>(arrivals_.size());
  if (n < 0) {
    latch_.set({.fault = Fault::kBusDown,
                .kind = kind_of(CanCause::kCall),
                .code = static_cast<std::uint32_t>(-n)});
    return {};
  }
  std::size_t frames = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    const auto& arrival = arrivals_[i];
    if (const auto frame = unpack(arrival.bytes))
      received_[frames++] = {.frame = *frame, .age_ns = arrival.age_ns};
    else if (const auto error =
                 decode_can_error(std::span(arrival.bytes).template first<kCanFrameBytes>()))
      evaluate(*error);
    else
      ++counts_.unreadable;
  }
  return std::span(received_).first(frames);
}

template <class Frame>
void BasicCanBus<Frame>::evaluate(const CanError& error) RT_SAFE {
  ++counts_.error_frames;
  errors_seen_.classes |= error.classes;
  errors_seen_.controller = static_cast<std::uint8_t>(errors_seen_.controller | error.controller);
  if (!error.is_bus_gone()) return;
  latch_.set(
      {.fault = Fault::kBusOff,
       .kind = kind_of(CanCause::kErrorFrame),
       .code = (error.classes & 0xFFFFu) | static_cast<std::uint32_t>(error.controller) << 16});
}

template <class Frame>
void BasicCanBus<Frame>::push(const std::optional<Frame>& frame) RT_SAFE {
  const auto bytes = frame ? pack_can_frame(*frame) : std::nullopt;
  if (!bytes || batched_ == batch_.size()) {
    batch_whole_ = false;
    return;
  }
  batch_[batched_++] = *bytes;
}

template <class Frame>
void BasicCanBus<Frame>::send() RT_SAFE {
  const std::size_t wanted = batched_;
  const bool whole = batch_whole_;
  batched_ = 0;
  batch_whole_ = true;
  if (wanted == 0 && whole) return;
  const int n = socket_->send(std::span(batch_).first(wanted));
  if (n < 0 && !is_no_room(-n)) {
    latch_.set({.fault = Fault::kBusDown,
                .kind = kind_of(CanCause::kCall),
                .code = static_cast<std::uint32_t>(-n)});
  }
  if (whole && n == static_cast<int>(wanted)) {
    missed_in_a_row_ = 0;
    return;
  }
  miss();
}

template <class Frame>
auto BasicCanBus<Frame>::take_batch() -> std::span<const Bytes> {
  batch_whole_ = true;
  return std::span(batch_).first(std::exchange(batched_, 0));
}

template <class Frame>
void BasicCanBus<Frame>::miss() RT_SAFE {
  ++counts_.missed_cycles;
  if (++missed_in_a_row_ < kMaxMissedInARow) return;
  latch_.set({.fault = Fault::kBusDown, .kind = kind_of(CanCause::kNoRoom)});
}

std::string can_bus_fault_detail(const FaultCause& cause, const std::string& interface,
                                 const char* link_type) {
  switch (static_cast<CanCause>(cause.kind)) {
    case CanCause::kCall:
      return fmt::format(
          "{}: {}; is the adapter plugged in and the interface up? ip link set {} up {}", interface,
          std::strerror(static_cast<int>(cause.code)), interface, link_type);
    case CanCause::kNoRoom:
      return fmt::format(
          "{} took no frames for {} ticks: no acknowledge, or its queue is too short; are the "
          "drives powered? ip link set {} txqueuelen 100",
          interface, CanBus::kMaxMissedInARow, interface);
    case CanCause::kErrorFrame:
      return fmt::format("{}: {}", interface,
                         CanError{.classes = cause.code & 0xFFFFu,
                                  .controller = static_cast<std::uint8_t>(cause.code >> 16)}
                             .text());
    default:
      return {};
  }
}

template <class Frame>
std::string silent_bus_detail(const BasicCanBus<Frame>& bus, const std::string& interface) {
  using enum CanErrorClass;
  using enum CanControllerState;
  const CanError& seen = bus.errors_seen();
  const bool disturbed =
      seen.has(kBusOff) || seen.has(kProtocol) || seen.has(kBusError) || seen.has(kRxPassive);
  const bool unheard =
      seen.has(kNoAck) || seen.has(kTxPassive) || bus.cause().kind == kind_of(CanCause::kNoRoom);
  if (unheard && !seen.has(kBusOff)) {
    return fmt::format(
        "no node on {} acknowledges a frame: switch the drives on and connect them; if they are "
        "on, "
        "give {} their bit rate",
        interface, interface);
  }
  if (disturbed) {
    return fmt::format(
        "{0} understands nothing of what is on the bus: give it the drives' bit rate (sudo ip link "
        "set {0} down; sudo ip link set {0} up {1}) and check both 120 ohm terminators",
        interface, Frame::kLinkType);
  }
  if (bus.fault() != Fault::kNone)
    return can_bus_fault_detail(bus.cause(), interface, Frame::kLinkType);
  return fmt::format(
      "no drive is heard on {}: are they on, at its bit rate and at the nodes of device.can.node?",
      interface);
}

template class BasicCanBus<CanFrame>;
template class BasicCanBus<CanFdFrame>;
template std::string silent_bus_detail(const CanBus&, const std::string&);
template std::string silent_bus_detail(const CanFdBus&, const std::string&);

}  // namespace tact::hal::can
