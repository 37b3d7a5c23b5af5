// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/usbfs_pipe.h"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "hal/falcon/falcon_boot.h"
#include "hal/monotonic.h"

namespace tact::hal::falcon_usb {
namespace {

constexpr std::int64_t kStopPause_ns = 1'000'000;

bool is_gone(int error) RT_SAFE { return error == ENODEV || error == ESHUTDOWN; }

}  // namespace

model::Result<std::unique_ptr<falcon::FalconPipe>> UsbfsPipe::start(
    std::unique_ptr<UsbfsPort> port) {
  std::unique_ptr<UsbfsPipe> pipe(new UsbfsPipe(std::move(port)));
  for (std::size_t i = 0; i < kIn; ++i) {
    const int error = pipe->port_->submit(*pipe->urbs_[i]);
    if (error != 0)
      return model::Error{fmt::format(
          "the Falcon's USB transfers cannot be started ({}): unplug it and plug it in again",
          std::strerror(error))};
    pipe->busy_[i] = true;
  }
  if (auto error = pipe->thread_.start([&pipe = *pipe] { pipe.run(); })) return std::move(*error);
  return std::unique_ptr<falcon::FalconPipe>(std::move(pipe));
}

UsbfsPipe::UsbfsPipe(std::unique_ptr<UsbfsPort> port) : port_(std::move(port)) {
  const std::span<std::uint8_t> buffer = port_->buffer();
  for (std::size_t i = 0; i < urbs_.size(); ++i) {
    const bool is_in = i < kIn;
    urbs_[i] = std::make_unique<usbdevfs_urb>();
    urbs_[i]->type = USBDEVFS_URB_TYPE_BULK;
    urbs_[i]->endpoint = is_in ? falcon::kFalconEndpointIn : falcon::kFalconEndpointOut;
    // In the kernel's own pages where it maps them: then it copies nothing (UB-2).
    urbs_[i]->buffer = buffer.subspan(i * kFalconTransfer, kFalconTransfer).data();
    urbs_[i]->buffer_length = static_cast<int>(is_in ? kFalconTransfer : falcon::kFalconPacketSize);
  }
}

UsbfsPipe::~UsbfsPipe() { stop(encode(falcon::FalconCommand{.lights = falcon::kFalconRed})); }

bool UsbfsPipe::submit(const falcon::FalconPacket& command) RT_SAFE {
  if (receiver_.gone()) return false;
  // Relaxed, and no increment: the loop alone writes it, the thread only looks for a change.
  commands_.store(commands_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  for (std::size_t i = kIn; i < kOwn; ++i) {
    // Acquire with completed(): the thread is done with the buffer.
    if (busy_[i].load(std::memory_order_acquire)) continue;
    std::memcpy(urbs_[i]->buffer, command.data(), command.size());
    // Before submit: the thread may reap it before submit has returned.
    busy_[i].store(true, std::memory_order_release);
    const int error = port_->submit(*urbs_[i]);
    if (error == 0) return true;
    busy_[i].store(false, std::memory_order_release);
    if (is_gone(error)) finish(error);
    return false;  // no memory, or busy: a missed cycle
  }
  return false;
}

void UsbfsPipe::finish(int error) RT_SAFE {
  receiver_.finish(is_gone(error)   ? falcon::FalconPipeEnd::kUnplugged
                   : error == EPIPE ? falcon::FalconPipeEnd::kStalled
                                    : falcon::FalconPipeEnd::kBroken,
                   error);
}

/// Leaves for good as soon as the device is gone, or the kernel refuses to be waited for: waiting
/// would then return at once, without end.
void UsbfsPipe::run() {
  FalconTurns turns;
  int last_error = EIO;
  while (!(stopping_.load(std::memory_order_acquire) && !any_busy(0))) {
    if (receiver_.gone()) return;
    if (!receiver_.open() && !any_busy(0)) {  // nothing under way would never come back
      stand_in_for_loop(monotonic_ns());
      usb_pause_ns(FalconTurns::kPause_ns);
      continue;
    }
    usbdevfs_urb* urb = nullptr;
    const int refusal = port_->reap(urb);
    int error = refusal;
    bool result = false;
    if (refusal == 0 && urb != nullptr) {
      error = -urb->status;
      result = completed(*urb);
    }
    if (is_gone(error)) finish(error);
    if (receiver_.gone()) return;
    if (error != 0) last_error = error;
    const FalconTurns::Next next = turns.turn(result);
    if (next == FalconTurns::Next::kEnd) finish(last_error);
    if (next == FalconTurns::Next::kEnd && refusal != 0) return;
    if (next != FalconTurns::Next::kGoOn) usb_pause_ns(FalconTurns::kPause_ns);
  }
}

bool UsbfsPipe::completed(usbdevfs_urb& urb) {
  const auto found = std::ranges::find(urbs_, &urb, &std::unique_ptr<usbdevfs_urb>::get);
  if (found == urbs_.end()) return false;
  const auto i = static_cast<std::size_t>(found - urbs_.begin());
  const bool is_in = i < kIn;
  // What stop() has asked for comes back so; it is progress only then.
  const bool discarded = urb.status == -ENOENT || urb.status == -ECONNRESET;
  const int size = std::clamp(urb.actual_length, 0, urb.buffer_length);
  // An IN transfer without even its status is no result.
  const bool good =
      urb.status == 0 && (!is_in || size >= static_cast<int>(falcon::kFtdiStatusSize));
  if (urb.status == -EPIPE) finish(EPIPE);
  if (!is_in) command_completed(-urb.status);
  if (is_in) {  // also a device that has nothing to say answers at its latency timer
    const std::int64_t now_ns = monotonic_ns();
    if (urb.status == 0)
      receiver_.take({static_cast<const std::uint8_t*>(urb.buffer), static_cast<std::size_t>(size)},
                     now_ns);
    stand_in_for_loop(now_ns);
  }
  // Commands are not sent again: the next tick has a newer one.
  const bool again = is_in && !stopping_.load(std::memory_order_acquire) && receiver_.open();
  const int error = again ? port_->submit(urb) : 0;
  if (error != 0) finish(error);
  busy_[i].store(again && error == 0, std::memory_order_release);  // from here the loop may take it
  return good || (discarded && stopping_.load(std::memory_order_acquire));
}

/// The command endpoint carries again before the next one: also what waits behind a refused command
/// may be a force, and goes.
void UsbfsPipe::command_completed(int error) {
  command_error_.store(error, std::memory_order_relaxed);  // released with its busy_
  if (error != EPIPE) return;
  for (std::size_t i = kIn; i < kOwn; ++i) port_->discard(*urbs_[i]);
  static_cast<void>(
      port_->clear_halt(falcon::kFalconEndpointOut));  // refused: the next command stalls again
}

void UsbfsPipe::stand_in_for_loop(std::int64_t now_ns) {
  if (!silence_.is_due(commands_.load(std::memory_order_relaxed), now_ns)) return;
  // Zeros are under way already; they are sent again only after they came back.
  if (busy_[kOwn].load(std::memory_order_acquire)) return;
  receiver_.stand_in();
  const falcon::FalconPacket zero = LoopSilence::zero();
  std::memcpy(urbs_[kOwn]->buffer, zero.data(), zero.size());
  busy_[kOwn].store(true, std::memory_order_release);
  if (port_->submit(*urbs_[kOwn]) != 0) busy_[kOwn].store(false, std::memory_order_release);
}

bool UsbfsPipe::any_busy(std::size_t from) const {
  return std::any_of(busy_.begin() + static_cast<std::ptrdiff_t>(from), busy_.end(),
                     [](const auto& busy) { return busy.load(std::memory_order_acquire); });
}

/// Has the device taken it? Commands come back in the order they left.
bool UsbfsPipe::send_last(const falcon::FalconPacket& last) {
  const std::int64_t until_ns = monotonic_ns() + falcon::kFalconLastCommand_ns;
  const auto wait = [&](auto done) {
    for (;;) {
      if (done()) return true;
      if (receiver_.gone() || thread_.ended() || monotonic_ns() >= until_ns) return false;
      usb_pause_ns(kStopPause_ns / 4);
    }
  };
  const auto idle = [&] { return !any_busy(kIn); };
  while (wait([&] { return submit(last); }) && wait(idle))
    if (command_error_.load(std::memory_order_relaxed) == 0) return true;
  return false;
}

void UsbfsPipe::stop(const falcon::FalconPacket& last) {
  if (stopping_.load(std::memory_order_acquire)) return;
  if (thread_.started()) static_cast<void>(send_last(last));
  stopping_.store(true, std::memory_order_release);
  while (thread_.started() && !thread_.ended()) {
    for (const auto& urb : urbs_) port_->discard(*urb);  // again: one may be new since
    usb_pause_ns(kStopPause_ns);
  }
  thread_.join();
  if (receiver_.health().end == falcon::FalconPipeEnd::kStalled && !receiver_.gone())
    static_cast<void>(port_->clear_halt(falcon::kFalconEndpointIn));  // for the next one to open it
  port_.reset();
}

}  // namespace tact::hal::falcon_usb
